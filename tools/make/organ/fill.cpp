// SPDX-License-Identifier: Apache-2.0
#include <Eigen/Geometry>
#include <algorithm>

#include "tools/make/organ/fill_file.h"
#include "tools/make/organ/odd_length.h"
#include "tools/make/organ/progress.h"
#include "tools/make/organ/repair/remesh_surface.h"
#include "tools/make/organ/size_estimate.h"
#include "tools/mesh/fill_surface.h"
#include "tools/mesh/mesh_error.h"
#include "tools/mesh/statistics.h"
#include "tools/mesh/topology.h"
#include "tools/program/exit_code.h"
#include "tools/program/printed.h"

namespace palpate::organ {
namespace {

using mesh::MeshError;
using mesh::Solid;
using program::printed;
using program::UsageError;

constexpr double kCoarse = 1.0 / 3;   // element size over the shortest side, above which it is told
constexpr double kLostVolume = 0.02;  // share, above which it is told
constexpr double kBadQuality = 0.1;   // of mesh::quality(), below which an element is told

Eigen::AlignedBox3d boxOf(const Solid& solid) {
  Eigen::AlignedBox3d box;
  for (const auto& x : solid.surface.vertices) box.extend(x);
  return box;
}

double meanEdge(const mesh::TriangleSurface& surface) {
  double sum = 0;
  for (const auto& t : surface.triangles)
    for (std::size_t k = 0; k < 3; ++k)
      sum += (surface.vertices[static_cast<std::size_t>(t[k])] -
              surface.vertices[static_cast<std::size_t>(t[(k + 1) % 3])])
                 .norm();
  return sum / (3.0 * static_cast<double>(surface.triangles.size()));
}

// A size that was meant in mm, or in cm.
std::string sizeSuspected(double size, double side) {
  for (const double unit : {1e-3, 1e-2})
    if (size * unit < kCoarse * side && size * unit > side / 300)
      return printed("; was it meant in %s? --element-size %.4g", unit == 1e-3 ? "mm" : "cm", size * unit);
  return "";
}

/// @param odd  what makes the body's length odd: then advice on sizes would be about a wrong body
void checkNotTooCoarse(double size, double side, const std::string& odd, std::vector<std::string>& notes) {
  if (size > side)
    throw UsageError(
        printed("--element-size: elements of %.4g m are longer than the body's shortest side, %.4g m; ", size,
                side) +
        (odd.empty() ? printed("at most %.3g m resolves it", kCoarse * side) + sizeSuspected(size, side)
                     : odd));
  if (size > kCoarse * side)
    notes.push_back(
        printed("--element-size: the body's shortest side, %.4g m, is %.1f elements of %.4g m long; at "
                "most %.3g m resolves it",
                side, side / size, size, kCoarse * side));
}

/// @param sizes  with the size that the surface's triangles have, where they are kept
void checkNotTooFine(const Body& body, const mesh::ElementSizes& sizes, const ImportOptions& options,
                     const SizeEstimate& expected, const std::string& odd) {
  if (expected.nodes <= options.max_nodes) return;
  const double fitting = smallestSize(body, sizes, options.order.value_or(1), options.max_nodes);
  const std::string asked = options.sizes.surface > 0
                                ? printed("--element-size %.4g", sizes.surface)
                                : printed("the surface's triangles of %.4g m", sizes.surface);
  throw UsageError(
      "--max-nodes: with " + asked + " the body has " + expected.inWords() +
      printed(", more than the %.6g nodes allowed; --element-size %.3g fits", options.max_nodes, fitting) +
      (odd.empty() ? "" : "; " + odd));
}

void noteVolume(const Solid& solid, const mesh::TetMesh& mesh, std::vector<std::string>& notes) {
  double volume = 0;
  for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t) volume += std::abs(mesh::signedVolume(mesh, t));
  const double lost = 1 - volume / solid.volume;
  if (std::abs(lost) <= kLostVolume) return;
  notes.push_back(
      printed("the elements hold %.4g m^3, %.1f %% %s than the surface's %.4g m^3: smaller elements "
              "follow it more closely",
              volume, 100 * std::abs(lost), lost > 0 ? "less" : "more", solid.volume));
}

void noteBadElements(const mesh::TetMesh& mesh, std::vector<std::string>& notes) {
  std::size_t bad = 0;
  double worst = 1;
  for (const auto& t : mesh.tetrahedra) {
    const auto at = [&](std::size_t k) { return mesh.nodes[static_cast<std::size_t>(t[k])]; };
    const double quality = mesh::quality(at(0), at(1), at(2), at(3));
    bad += quality < kBadQuality;
    worst = std::min(worst, quality);
  }
  if (bad > 0)
    notes.push_back(
        printed("%zu of %zu tetrahedra are nearly flat: their quality is below %.2g, the worst has %.2g "
                "(1 is regular)",
                bad, mesh.tetrahedra.size(), kBadQuality, worst));
}

// Gmsh remeshes sound surfaces, and keeps their sharp edges. One that was repaired, or that Gmsh cannot flatten, is given
// its triangles before.
mesh::TetMesh filledBy(const Solid& solid, const ImportOptions& options, std::vector<std::string>& notes) {
  if (options.sizes.surface == 0) return mesh::fillSurface(solid.surface, options.sizes);
  if (!options.repair) {
    try {
      return mesh::fillSurface(solid.surface, options.sizes);
    } catch (const MeshError& error) {
      notes.push_back("the surface was remeshed by CGAL, which rounds sharp edges, as Gmsh could not: " +
                      std::string(error.what()));
    }
  }
  mesh::ElementSizes kept = options.sizes;
  kept.surface = 0;
  return mesh::fillSurface(remeshed(solid.surface, options.sizes.surface), kept);
}

mesh::TetMesh filled(const Solid& solid, const ImportOptions& options, double expected_s,
                     std::vector<std::string>& notes) {
  const mesh::ElementSizes& sizes = options.sizes;
  const Progress progress(options.progress, expected_s);
  try {
    return filledBy(solid, options, notes);
  } catch (const MeshError& error) {
    const double own = meanEdge(solid.surface);
    const std::string advice = sizes.surface > 0
                                   ? printed(
                                         "; try --element-size %.3g, about the length of the surface's own "
                                         "edges, or none, which keeps "
                                         "its triangles",
                                         sizes.surface < own ? own : std::max(own, sizes.surface / 2))
                                   : printed("; try --element-size %.3g, which remeshes the surface", own);
    throw MeshError(error.what() + advice);
  }
}

}  // namespace

SizeEstimate checkSizes(const Solid& solid, const ImportOptions& options, std::vector<std::string>& notes) {
  const Eigen::Vector3d sides = boxOf(solid).sizes();
  const std::string odd = oddLength(sides.maxCoeff(), options.scale).value_or("");
  const Body body{solid.volume, mesh::areaOf(solid.surface), sides.minCoeff()};
  mesh::ElementSizes sizes = options.sizes;
  if (sizes.surface > 0)
    checkNotTooCoarse(sizes.surface, body.shortest_side, odd, notes);
  else
    sizes.surface = meanEdge(solid.surface);
  const SizeEstimate expected = estimate(body, sizes, options.order.value_or(1));
  checkNotTooFine(body, sizes, options, expected, odd);
  options.say("estimate         " + expected.inWords());
  if (!odd.empty()) notes.push_back(odd);
  return expected;
}

mesh::TetMesh fill(const Solid& solid, const ImportOptions& options, std::vector<std::string>& notes) {
  const SizeEstimate expected = checkSizes(solid, options, notes);
  mesh::TetMesh mesh = filled(solid, options, expected.seconds, notes);
  noteVolume(solid, mesh, notes);
  noteBadElements(mesh, notes);
  return mesh;
}

}  // namespace palpate::organ
