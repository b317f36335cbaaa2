// SPDX-License-Identifier: Apache-2.0
#include "tools/examine/feel/contrast_map.h"

#include "core/surface/surface_mesh.h"
#include "tools/picture/surface_picture.h"
#include "tools/program/printed.h"
#include "tools/program/vtu.h"

namespace palpate::feel {

using program::printed;

std::string contrastSvg(const Pair& pair, const ContrastField& field,
                        const std::vector<RegionContrast>& regions, double depth) {
  const ModelView& view = pair.model.view();
  const std::size_t most = largest(field);
  picture::SurfacePicture picture;
  picture.title = printed("Contrast F / F_without - 1 of the normal force, %.3g mm deep", 1e3 * depth);
  picture.bar_label = "contrast / %";
  picture.surface.positions = view.surface_positions;
  picture.surface.triangles = view.surface_triangles;
  for (const auto& press : field.presses)
    picture.surface.numbers.push_back(press ? std::optional(100.0 * press->contrast()) : std::nullopt);
  picture.surface.towards_eye = pair.model.surface().nodeNormal(static_cast<int>(most));
  picture.cross = Eigen::Map<const Vec3>(view.surface_positions.data() + 3 * most);
  picture.cross_label = printed("largest contrast, %.3g %%", 100.0 * field.presses[most]->contrast());
  for (const RegionContrast& region : regions) {
    if (region.surface.triangles.empty()) continue;
    const double under = (region.above - region.surface.centre).norm();
    picture.inside.push_back(
        {region.name + printed(", its centre %.3g mm under the surface", 1e3 * under), &region.surface});
  }
  return picture.svg();
}

std::string contrastVtu(const Pair& pair, const ContrastField& field) {
  const ModelView& view = pair.model.view();
  std::vector<double> contrast, force, without;
  std::vector<std::uint8_t> beyond, pressed;
  for (const auto& press : field.presses) {
    contrast.push_back(press ? press->contrast() : 0.0);
    force.push_back(press ? press->force : 0.0);
    without.push_back(press ? press->without_force : 0.0);
    beyond.push_back(press && press->beyond ? 1 : 0);
    pressed.push_back(press ? 1 : 0);
  }
  return program::vtuText({.points = {view.surface_positions.begin(), view.surface_positions.end()},
                           .triangles = {view.surface_triangles.begin(), view.surface_triangles.end()},
                           .data = {{"contrast", contrast},
                                    {"force", force},
                                    {"force_without", without},
                                    {"beyond_domain", beyond},
                                    {"pressed", pressed}}});
}

}  // namespace palpate::feel
