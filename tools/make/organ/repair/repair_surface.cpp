// SPDX-License-Identifier: Apache-2.0
// The only file that includes CGAL: its templates take long to compile.
#include "tools/make/organ/repair/repair_surface.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/bbox.h>
#include <CGAL/Polygon_mesh_processing/border.h>
#include <CGAL/Polygon_mesh_processing/connected_components.h>
#include <CGAL/Polygon_mesh_processing/manifoldness.h>
#include <CGAL/Polygon_mesh_processing/measure.h>
#include <CGAL/Polygon_mesh_processing/orient_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Polygon_mesh_processing/repair_degeneracies.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Polygon_mesh_processing/stitch_borders.h>
#include <CGAL/Polygon_mesh_processing/triangulate_hole.h>
#include <CGAL/Surface_mesh.h>

#include <algorithm>
#include <cstdio>
#include <numeric>
#include <set>

#include "tools/make/organ/repair/soup.h"
#include "tools/mesh/mesh_error.h"
#include "tools/mesh/surface_defects.h"
#include "tools/mesh/surface_solids.h"

namespace palpate::organ {
namespace {

namespace pmp = CGAL::Polygon_mesh_processing;
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;
using Mesh = CGAL::Surface_mesh<Point>;
using Face = Mesh::Face_index;
using Halfedge = Mesh::Halfedge_index;
using mesh::TriangleSurface;

constexpr int kRounds = 12;  // of taking away what crosses; then it is given up
constexpr double kCap =
    -0.99999999;                 // cosine of the widest angle of a triangle that is not a cap, 179.99 degrees
constexpr double kNeedle = 1e5;  // longest over shortest edge of a needle

struct Soup {
  std::vector<Point> points;
  std::vector<std::vector<std::size_t>> polygons;
};

Soup soupOf(const TriangleSurface& surface) {
  Soup soup;
  for (const auto& x : surface.vertices) soup.points.emplace_back(x.x(), x.y(), x.z());
  for (const auto& t : surface.triangles) soup.polygons.emplace_back(t.begin(), t.end());
  return soup;
}

TriangleSurface surfaceOf(const Soup& soup) {
  TriangleSurface surface;
  for (const Point& p : soup.points) surface.vertices.emplace_back(p.x(), p.y(), p.z());
  for (const auto& t : soup.polygons)
    surface.triangles.push_back(
        {static_cast<std::int32_t>(t[0]), static_cast<std::int32_t>(t[1]), static_cast<std::int32_t>(t[2])});
  surface.vertex_tags.resize(surface.vertices.size());
  surface.triangle_tags.resize(surface.triangles.size());
  std::iota(surface.vertex_tags.begin(), surface.vertex_tags.end(), 1);
  std::iota(surface.triangle_tags.begin(), surface.triangle_tags.end(), 1);
  return surface;
}

// A part faces outward where it encloses a positive volume.
void turnPartsOutward(Soup& soup) {
  const TriangleSurface surface = surfaceOf(soup);
  const std::vector<std::size_t> part = mesh::partsOf(surface);
  std::vector<TriangleSurface> parts(*std::max_element(part.begin(), part.end()) + 1);
  for (std::size_t t = 0; t < part.size(); ++t) {
    TriangleSurface& own = parts[part[t]];
    const auto first = static_cast<std::int32_t>(own.vertices.size());
    for (const auto v : surface.triangles[t])
      own.vertices.push_back(surface.vertices[static_cast<std::size_t>(v)]);
    own.triangles.push_back({first, first + 1, first + 2});
  }
  for (std::size_t t = 0; t < part.size(); ++t)
    if (mesh::enclosedVolume(parts[part[t]]) < 0) std::swap(soup.polygons[t][1], soup.polygons[t][2]);
}

std::size_t turnedOver(const Soup& before, const Soup& after) {
  std::size_t count = 0;
  for (std::size_t t = 0; t < before.polygons.size(); ++t) {
    const Point& first = before.points[before.polygons[t][0]];
    const auto& now = after.polygons[t];
    std::size_t k = 0;
    while (k < 2 && after.points[now[k]] != first) ++k;
    count += after.points[now[(k + 1) % 3]] != before.points[before.polygons[t][1]];
  }
  return count;
}

Mesh orientedMesh(const TriangleSurface& surface, Repairs& repairs) {
  const Soup file = soupOf(surface);
  Soup soup = file;
  pmp::orient_polygon_soup(soup.points, soup.polygons);  // parts edges in more than two triangles, too
  turnPartsOutward(soup);
  repairs.turned_over = turnedOver(file, soup);
  repairs.volume_before = mesh::enclosedVolume(surfaceOf(soup));
  Mesh mesh;
  pmp::polygon_soup_to_polygon_mesh(soup.points, soup.polygons, mesh);
  return mesh;
}

// Leaves out pieces with a rim that are small beside the whole.
void leaveOutLoosePieces(Mesh& mesh, std::size_t& count) {
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
  for (std::size_t p = 0; p < parts; ++p) {
    if (!is_open[p] || area[p] > kLoosePiece * whole) continue;
    loose.push_back(p);
    count += faces[p].size();
  }
  pmp::remove_connected_components(mesh, loose, part);
  mesh.remove_property_map(part);
}

std::string placeInWords(const CGAL::Bbox_3& box) {
  char text[120];
  std::snprintf(text, sizeof text, "(%.4g %.4g %.4g) m", (box.xmin() + box.xmax()) / 2,
                (box.ymin() + box.ymax()) / 2, (box.zmin() + box.zmax()) / 2);
  return text;
}

double diagonalOf(const CGAL::Bbox_3& box) {
  return std::sqrt(CGAL::square(box.x_span()) + CGAL::square(box.y_span()) + CGAL::square(box.z_span()));
}

CGAL::Bbox_3 rimBox(const Mesh& mesh, Halfedge rim) {
  CGAL::Bbox_3 box;
  for (const Halfedge h : CGAL::halfedges_around_face(rim, mesh)) box += mesh.point(mesh.target(h)).bbox();
  return box;
}

/// @param largest  part of the body's diagonal that a hole may span
void checkHole(const Mesh& mesh, Halfedge rim, double diagonal, double largest) {
  const CGAL::Bbox_3 box = rimBox(mesh, rim);
  const double span = diagonalOf(box);
  if (span <= largest * diagonal) return;
  char text[160];
  std::snprintf(text, sizeof text,
                " spans %.4g m, more than the %.3g m (%.0f %% of the body's diagonal) that --repair fills",
                span, largest * diagonal, 100 * largest);
  throw mesh::MeshError("the hole at " + placeInWords(box) + text);
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

/// @return how many
std::size_t fillHoles(Mesh& mesh, double diagonal, double largest, Patch patch, std::size_t& fills) {
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

void mendFlatTriangles(Mesh& mesh, std::size_t& count) {
  const std::size_t before = mesh.number_of_faces();
  pmp::remove_degenerate_faces(mesh);
  pmp::experimental::remove_almost_degenerate_faces(mesh.faces(), mesh, kCap, kNeedle, 0.0);
  count += before - std::min<std::size_t>(before, mesh.number_of_faces());
}

// What crosses is taken away with a ring around it and filled; what crosses then, with taut patches and wider rings.
void mendCrossings(Mesh& mesh, double diagonal, Repairs& repairs) {
  std::set<Face> faces = crossingFaces(mesh);
  for (int round = 0; !faces.empty(); ++round) {
    if (round == kRounds)
      throw mesh::MeshError(std::to_string(faces.size()) + " triangles still cross after " +
                            std::to_string(kRounds) + " rounds of --repair, one at " +
                            placeInWords(pmp::face_bbox(*faces.begin(), mesh)));
    for (int ring = 0; ring <= round / 4; ++ring) addRing(mesh, faces);
    repairs.crossing_removed += faces.size();
    takeAway(mesh, faces);
    leaveOutLoosePieces(mesh, repairs.crossing_removed);
    fillHoles(mesh, diagonal, kLargestWound, round < 2 ? Patch::kSmooth : Patch::kTaut, repairs.fills);
    std::size_t not_told = 0;
    mendFlatTriangles(mesh, not_told);
    faces = crossingFaces(mesh);
  }
}

TriangleSurface surfaceOf(Mesh& mesh) {
  mesh.collect_garbage();
  Soup soup;
  for (const auto v : mesh.vertices()) soup.points.push_back(mesh.point(v));
  for (const Face f : mesh.faces()) {
    auto& polygon = soup.polygons.emplace_back();
    for (const auto v : mesh.vertices_around_face(mesh.halfedge(f))) polygon.push_back(v);
  }
  return surfaceOf(soup);
}

}  // namespace

TriangleSurface repairSurface(const TriangleSurface& surface, Repairs& repairs) {
  repairs = {};
  const TriangleSurface clean = cleaned(surface, repairs);
  repairs.volume_of_file = mesh::enclosedVolume(clean);
  repairs.crossing_pairs = mesh::selfIntersections(clean).size();
  Mesh mesh = orientedMesh(clean, repairs);
  const double diagonal = diagonalOf(pmp::bbox(mesh));
  // Loose pieces hang on edges in three triangles: without them, the other two become one edge again.
  repairs.stitched = pmp::stitch_borders(mesh);
  leaveOutLoosePieces(mesh, repairs.loose);
  repairs.stitched += pmp::stitch_borders(mesh);
  pmp::duplicate_non_manifold_vertices(mesh);
  mendFlatTriangles(mesh, repairs.flat);
  repairs.holes = fillHoles(mesh, diagonal, kLargestHole, Patch::kSmooth, repairs.fills);
  mendCrossings(mesh, diagonal, repairs);
  TriangleSurface whole = surfaceOf(mesh);
  if (whole.triangles.empty()) throw mesh::MeshError("--repair leaves nothing of the surface");
  repairs.volume_after = mesh::enclosedVolume(whole);
  const auto defects = mesh::surfaceDefects(whole);
  if (!defects.empty()) throw mesh::MeshError("--repair leaves defects: " + mesh::inWords(defects));
  return whole;
}

}  // namespace palpate::organ
