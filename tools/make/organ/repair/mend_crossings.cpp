// SPDX-License-Identifier: Apache-2.0
#include "tools/make/organ/repair/mend_crossings.h"

#include <CGAL/Polygon_mesh_processing/bbox.h>
#include <CGAL/Polygon_mesh_processing/border.h>
#include <CGAL/Polygon_mesh_processing/compute_normal.h>
#include <CGAL/Polygon_mesh_processing/connected_components.h>
#include <CGAL/Polygon_mesh_processing/manifoldness.h>
#include <CGAL/Polygon_mesh_processing/measure.h>
#include <CGAL/Polygon_mesh_processing/repair_degeneracies.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Polygon_mesh_processing/triangulate_hole.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "tools/mesh/mesh_error.h"
#include "tools/program/printed.h"

namespace palpate::organ {
namespace {

namespace pmp = CGAL::Polygon_mesh_processing;

constexpr int kRounds = 12;     // of taking away what crosses; then it is given up
constexpr int kFoldRounds = 4;  // of taking away what folds, which may stay
constexpr double kCap =
    -0.99999999;                 // cosine of the widest angle of a triangle that is not a cap, 179.99 degrees
constexpr double kNeedle = 1e5;  // longest over shortest edge of a needle

CGAL::Bbox_3 rimBox(const Mesh& mesh, Halfedge rim) {
  CGAL::Bbox_3 box;
  for (const Halfedge h : CGAL::halfedges_around_face(rim, mesh)) box += mesh.point(mesh.target(h)).bbox();
  return box;
}

void checkHole(const Mesh& mesh, Halfedge rim, double diagonal, double largest) {
  const CGAL::Bbox_3 box = rimBox(mesh, rim);
  const double span = diagonalOf(box);
  if (span <= largest * diagonal) return;
  throw mesh::MeshError(
      "the hole at " + placeInWords(box) +
      program::printed(
          " spans %.4g m, more than the %.3g m (%.0f %% of the body's diagonal) that --repair fills", span,
          largest * diagonal, 100 * largest));
}

enum class Patch { kSmooth, kTaut };

/// A patch of triangles as small as those around it. A smooth one goes on as the surface around it does; a taut one has
/// little area, and crosses its surroundings more seldom.
void fillHole(Mesh& mesh, Halfedge rim, Patch patch, std::size_t& fills) {
  std::vector<Face> faces;
  std::vector<Mesh::Vertex_index> vertices;
  const auto to_faces = std::back_inserter(faces);
  const auto to_vertices = std::back_inserter(vertices);
  if (patch == Patch::kSmooth)
    pmp::triangulate_refine_and_fair_hole(mesh, rim, to_faces, to_vertices);
  else
    pmp::triangulate_and_refine_hole(mesh, rim, to_faces, to_vertices);
  if (faces.empty())
    throw mesh::MeshError("the hole at " + placeInWords(rimBox(mesh, rim)) + " cannot be filled");
  fills += faces.size();
}

std::size_t fillHolesBy(Patch patch, Mesh& mesh, double diagonal, double largest, std::size_t& fills) {
  std::vector<Halfedge> rims;
  pmp::extract_boundary_cycles(mesh, std::back_inserter(rims));
  for (const Halfedge rim : rims) checkHole(mesh, rim, diagonal, largest);
  for (const Halfedge rim : rims) fillHole(mesh, rim, patch, fills);
  return rims.size();
}

std::set<Face> crossingFaces(const Mesh& mesh) {
  std::vector<std::pair<Face, Face>> found;
  pmp::self_intersections(mesh, std::back_inserter(found));
  std::set<Face> faces;
  for (const auto& [a, b] : found) faces.insert({a, b});
  return faces;
}

void addFolded(const Mesh& mesh, double least_fold, std::set<Face>& faces) {
  const double farthest = -std::cos(least_fold * std::numbers::pi / 180);
  for (const auto edge : mesh.edges()) {
    const Face a = mesh.face(mesh.halfedge(edge)), b = mesh.face(mesh.opposite(mesh.halfedge(edge)));
    if (pmp::compute_face_normal(a, mesh) * pmp::compute_face_normal(b, mesh) < farthest)
      faces.insert({a, b});
  }
}

void addRing(const Mesh& mesh, std::set<Face>& faces) {
  std::set<Face> wider = faces;
  for (const Face f : faces)
    for (const auto v : mesh.vertices_around_face(mesh.halfedge(f)))
      for (const Face g : mesh.faces_around_target(mesh.halfedge(v)))
        if (g != Mesh::null_face()) wider.insert(g);
  faces = std::move(wider);
}

void takeAway(Mesh& mesh, const std::set<Face>& faces) {
  for (const Face f : faces) CGAL::Euler::remove_face(mesh.halfedge(f), mesh);
  pmp::duplicate_non_manifold_vertices(mesh);
}

}  // namespace

std::size_t fillHoles(Mesh& mesh, double diagonal, double largest, std::size_t& fills) {
  return fillHolesBy(Patch::kSmooth, mesh, diagonal, largest, fills);
}

std::vector<LoosePiece> leaveOutLoosePieces(Mesh& mesh) {
  auto part = mesh.add_property_map<Face, std::size_t>("f:part").first;
  const std::size_t parts = pmp::connected_components(mesh, part);
  std::vector<double> area(parts, 0);
  std::vector<std::vector<Face>> faces(parts);
  std::vector<bool> is_open(parts, false);
  double whole = 0;
  for (const Face f : mesh.faces()) {
    area[part[f]] += pmp::face_area(f, mesh);
    faces[part[f]].push_back(f);
    for (const Halfedge h : mesh.halfedges_around_face(mesh.halfedge(f)))
      if (mesh.is_border(mesh.opposite(h))) is_open[part[f]] = true;
  }
  for (const double a : area) whole += a;
  std::vector<std::size_t> loose;
  std::vector<LoosePiece> pieces;
  for (std::size_t p = 0; p < parts; ++p) {
    if (!is_open[p] || area[p] > kLoosePiece * whole) continue;
    loose.push_back(p);
    CGAL::Bbox_3 box;
    for (const Face f : faces[p]) box += pmp::face_bbox(f, mesh);
    pieces.push_back({faces[p].size(), area[p], middleOf(box)});
  }
  pmp::remove_connected_components(mesh, loose, part);
  mesh.remove_property_map(part);
  std::stable_sort(pieces.begin(), pieces.end(),
                   [](const LoosePiece& a, const LoosePiece& b) { return a.area > b.area; });
  return pieces;
}

std::size_t mendFlatTriangles(Mesh& mesh) {
  const std::size_t before = mesh.number_of_faces();
  pmp::remove_degenerate_faces(mesh);
  pmp::experimental::remove_almost_degenerate_faces(mesh.faces(), mesh, kCap, kNeedle, 0.0);
  return before - std::min<std::size_t>(before, mesh.number_of_faces());
}

Mended mendCrossings(Mesh& mesh, double diagonal, double least_fold) {
  Mended mended;
  for (int round = 0;; ++round) {
    std::set<Face> faces = crossingFaces(mesh);
    if (round == kRounds && !faces.empty())
      throw mesh::MeshError(std::to_string(faces.size()) + " triangles still cross after " +
                            std::to_string(kRounds) + " rounds of --repair, one at " +
                            placeInWords(pmp::face_bbox(*faces.begin(), mesh)));
    if (round < kFoldRounds && least_fold > 0) addFolded(mesh, least_fold, faces);
    if (faces.empty()) return mended;
    for (int ring = 0; ring <= round / 4; ++ring) addRing(mesh, faces);
    mended.removed += faces.size();
    takeAway(mesh, faces);
    for (const LoosePiece& piece : leaveOutLoosePieces(mesh)) mended.removed += piece.triangles;
    fillHolesBy(round < 2 ? Patch::kSmooth : Patch::kTaut, mesh, diagonal, kLargestWound, mended.fills);
    (void)mendFlatTriangles(mesh);
  }
}

}  // namespace palpate::organ
