// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <filesystem>
#include <iostream>

#include "tools/examine/feel/contrast.h"
#include "tools/examine/feel/contrast_map.h"
#include "tools/examine/feel/studies.h"
#include "tools/program/json.h"
#include "tools/program/numbers.h"
#include "tools/program/printed.h"
#include "tools/program/write_file.h"

namespace palpate::feel {

namespace {

using program::Json;
using program::printed;

/// What the study found.
struct Found {
  const ContrastField& field;
  std::size_t most;  ///< node of the largest contrast
  std::vector<Ring> rings;
  const std::vector<RegionContrast>& regions;
  double above_half;  ///< share of the surface
};

Vec3 positionOf(const MetaModel& model, std::size_t node) {
  return Eigen::Map<const Vec3>(model.view().surface_positions.data() + 3 * node);
}

Json orNull(double number, bool known) {
  return known ? Json(number) : Json(nullptr);
}

Json toJson(const std::optional<Press>& press) {
  if (!press) return {{"contrast", nullptr}, {"force", nullptr}, {"force_without", nullptr}};
  return {{"contrast", press->contrast()},
          {"force", press->force},
          {"force_without", press->without_force},
          {"beyond_domain", press->beyond}};
}

Json toJson(const Study& study, const MetaModel& model, const Found& found) {
  Json largest = toJson(found.field.presses[found.most]);
  largest["node"] = model.view().surface_mesh_tag[found.most];
  largest["position"] = positionOf(model, found.most);
  Json rings = Json::array(), regions = Json::object();
  for (const Ring& ring : found.rings) {
    const bool any = ring.places > 0;
    rings.push_back({{"from", ring.from},
                     {"to", ring.to},
                     {"places", ring.places},
                     {"mean", orNull(ring.mean, any)},
                     {"min", orNull(ring.min, any)},
                     {"max", orNull(ring.max, any)}});
  }
  for (const RegionContrast& region : found.regions) {
    regions[region.name] = toJson(region.press);
    regions[region.name]["centre"] = region.surface.centre;
    regions[region.name]["nearest_surface"] = region.above;
  }
  return {{"depth", study.press_depth},
          {"places", found.field.places()},
          {"beyond_domain", found.field.beyond()},
          {"unanswered", found.field.unanswered},
          {"largest", largest},
          {"regions", regions},
          {"rings", rings},
          {"share_above_half", found.above_half}};
}

std::string inWords(const Vec3& X) {
  return printed("%.4f %.4f %.4f m", X.x(), X.y(), X.z());
}

std::string inWords(const std::optional<Press>& press) {
  if (!press) return "no tool gets there";
  return printed("%.4g and %.4g N, contrast %.1f %%", press->force, press->without_force,
                 100.0 * press->contrast()) +
         (press->beyond ? ", beyond d_max" : "");
}

void print(const Study& study, const MetaModel& model, const Found& found) {
  std::cout << printed(
                   "presses            %.3g mm deep at %zu places, %zu of them beyond d_max, %zu without an "
                   "answer\n",
                   1e3 * study.press_depth, found.field.places(), found.field.beyond(),
                   found.field.unanswered)
            << "largest contrast   at " << inWords(positionOf(model, found.most)) << ": "
            << inWords(found.field.presses[found.most]) << '\n';
  for (const RegionContrast& region : found.regions)
    std::cout << "region             " << region.name << ", its centre "
              << printed("%.1f mm under ", 1e3 * (region.above - region.surface.centre).norm())
              << inWords(region.above) << ": " << inWords(region.press) << '\n';
  std::cout << printed("above half of it   %.1f %% of the accessible surface\n", 100.0 * found.above_half)
            << "distance from it   places    mean     min     max\n";
  for (const Ring& ring : found.rings) {
    const std::string width = std::isinf(ring.to)
                                  ? printed("%.0f mm and more", 1e3 * ring.from)
                                  : printed("%.0f to %.0f mm", 1e3 * ring.from, 1e3 * ring.to);
    std::cout << printed("%-17s %8zu", width.c_str(), ring.places);
    if (ring.places > 0)
      std::cout << printed(" %6.1f%% %6.1f%% %6.1f%%", 100.0 * ring.mean, 100.0 * ring.min, 100.0 * ring.max);
    std::cout << '\n';
  }
}

std::string extensionOf(const std::string& map) {
  const std::string extension = std::filesystem::path(map).extension().string();
  if (map.empty() || extension == ".svg" || extension == ".vtu") return extension;
  throw program::ValueError("--map is '" + map + "', expected a name that ends in .svg or .vtu");
}

}  // namespace

int runContrast(const Study& study) {
  // 1. Both organs, if they are the same to a tool.
  const std::string extension = extensionOf(study.map);
  const MetaModel model = MetaModel::load(study.model), without = MetaModel::load(study.without);
  const Pair pair{model, without};
  checkComparable(pair);
  // 2. Press them everywhere, and over the regions.
  const ContrastField field = contrastField(pair, study.press_depth);
  const std::vector<RegionContrast> regions = regionContrasts(pair, study.press_depth);
  // 3. What that says,
  const std::size_t most = largest(field);
  const Found found{field, most, ringsRound(model, field, most), regions,
                    shareAbove(field, 0.5 * field.presses[most]->contrast())};
  // 4. as a map and as numbers.
  if (extension == ".svg")
    program::writeFile(study.map, contrastSvg(pair, field, regions, study.press_depth));
  if (extension == ".vtu") program::writeFile(study.map, contrastVtu(pair, field));
  if (study.json)
    program::printJson(toJson(study, model, found));
  else
    print(study, model, found);
  return 0;
}

}  // namespace palpate::feel
