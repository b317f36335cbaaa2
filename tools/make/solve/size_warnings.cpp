// SPDX-License-Identifier: Apache-2.0
#include "tools/make/solve/size_warnings.h"

#include <algorithm>

#include "tools/mesh/topology.h"
#include "tools/program/length_unit.h"
#include "tools/program/printed.h"
#include "tools/solver/build/solver_setup.h"

namespace palpate::solve_program {

namespace {

using program::lengthText;
using program::printed;

// What organs are, widely: brain and fat have some kPa, cartilage and tendon some MPa to 1 GPa.
constexpr double kSoftest = 500.0, kStiffest = 1e9;  // Pa
constexpr double kWide = 0.35;  // of the smallest side: radius of a patch that is most of the organ

void judgeModulus(const std::string& key, double E, std::vector<std::string>& warnings) {
  if (E < kSoftest)
    warnings.push_back(printed("%s = %.4g Pa is softer than any organ (1e3 to 1e6 Pa)", key.c_str(), E) +
                       (1e3 * E >= kSoftest ? printed("; in kPa it would be %.4g Pa", 1e3 * E) : ""));
  if (E > kStiffest)
    warnings.push_back(printed("%s = %.4g Pa is stiffer than any organ (1e3 to 1e6 Pa)", key.c_str(), E));
}

void judgeLength(double longest, std::vector<std::string>& warnings) {
  if (program::isOrganLength(longest)) return;
  std::string text = "the organ is " + lengthText(longest) + " long, expected " +
                     lengthText(program::kShortestOrgan) + " to " + lengthText(program::kLongestOrgan) +
                     "; a mesh is in metres";
  for (const program::LengthUnit& unit : program::kLengthUnits)
    if (unit.metres < 1.0 && program::isOrganLength(unit.metres * longest))
      text += "; in " + std::string(unit.plural) + " it would be " + lengthText(unit.metres * longest) +
              ": palpate-organ import --unit " + std::string(unit.word);
  for (const double twice : {1e3, 1e2})
    if (program::isOrganLength(twice * longest)) {
      text += printed("; was it scaled twice? times %g it would be %s", twice,
                      lengthText(twice * longest).c_str());
      break;
    }
  warnings.push_back(text);
}

double medianEdge(const mesh::TetMesh& organ, const mesh::BoundarySurface& boundary) {
  std::vector<double> lengths;
  const auto at = [&](std::int32_t node) -> const auto& {
    return organ.nodes[static_cast<std::size_t>(boundary.nodes[static_cast<std::size_t>(node)])];
  };
  for (const auto& face : boundary.faces)
    for (std::size_t k = 0; k < 3; ++k) lengths.push_back((at(face[k]) - at(face[(k + 1) % 3])).norm());
  const auto middle = lengths.begin() + static_cast<std::ptrdiff_t>(lengths.size() / 2);
  std::nth_element(lengths.begin(), middle, lengths.end());
  return *middle;
}

/// Nodes of the mesh before it was raised to quadratic elements.
std::ptrdiff_t cornersOf(const mesh::TetMesh& organ) {
  std::vector<bool> corner(organ.nodes.size());
  for (const auto& tetrahedron : organ.tetrahedra)
    for (const std::int32_t node : tetrahedron) corner[static_cast<std::size_t>(node)] = true;
  return std::count(corner.begin(), corner.end(), true);
}

void judgePatch(const solver::Case& c, const mesh::TetMesh& organ, double smallest,
                std::vector<std::string>& warnings) {
  if (c.nodalLoad()) return;
  const double edge = medianEdge(organ, mesh::boundaryOf(organ));
  const double a = c.patch_radius.value_or(solver::usualPatchRadius(edge, organ.isQuadratic()));
  if (a > std::max(0.5 * smallest, 1.3 * edge)) return;  // the solver refuses it
  if (a <= kWide * smallest) return;
  warnings.push_back(
      printed("the contact patch has a radius of %s on an organ whose smallest side is %s, with %td nodes: a "
              "tool takes hold of most of it; ",
              lengthText(a).c_str(), lengthText(smallest).c_str(), cornersOf(organ)) +
      (c.patch_radius ? "a smaller model.patch_radius" : "smaller elements, or a model.patch_radius,") +
      " would be a tool's");
}

}  // namespace

std::vector<std::string> sizeWarnings(const solver::Case& c, const mesh::TetMesh& organ) {
  std::vector<std::string> warnings;
  judgeModulus("material.E", c.E, warnings);
  for (const solver::RegionCase& region : c.regions)
    judgeModulus("E of region " + region.group, region.E, warnings);
  Eigen::Vector3d low = organ.nodes.front(), high = low;
  for (const Eigen::Vector3d& X : organ.nodes) {
    low = low.cwiseMin(X);
    high = high.cwiseMax(X);
  }
  judgeLength((high - low).maxCoeff(), warnings);
  judgePatch(c, organ, (high - low).minCoeff(), warnings);
  return warnings;
}

}  // namespace palpate::solve_program
