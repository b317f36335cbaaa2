// SPDX-License-Identifier: Apache-2.0
#include "tools/make/organ/report.h"

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <utility>

#include "tools/mesh/topology.h"

namespace palpate::organ {
namespace {

std::size_t groupSize(const mesh::TetMesh& mesh, const std::string& name) {
  const auto found = mesh.groups.find(name);
  return found == mesh.groups.end() ? 0 : found->second.size();
}

std::string inWords(const Eigen::Vector3d& x) {
  char text[80];
  std::snprintf(text, sizeof text, "%.4f %.4f %.4f", x.x(), x.y(), x.z());
  return text;
}

std::string inMillimetres(double length) {
  char text[32];
  std::snprintf(text, sizeof text, "%.1f", 1e3 * length);
  return text;
}

RegionReport regionOf(const mesh::TetMesh& mesh, const mesh::BoundarySurface& boundary,
                      const std::vector<std::int32_t>& tetrahedra) {
  RegionReport region{tetrahedra.size(), 0.0, Eigen::Vector3d::Zero(), {}};
  const auto node = [&](std::int32_t i) -> const Eigen::Vector3d& {
    return mesh.nodes[static_cast<std::size_t>(i)];
  };
  for (const std::int32_t t : tetrahedra) {
    const double volume = mesh::signedVolume(mesh, static_cast<std::size_t>(t));
    region.volume += volume;
    for (const std::int32_t corner : mesh.tetrahedra[static_cast<std::size_t>(t)])
      region.centre += 0.25 * volume * node(corner);
  }
  region.centre /= region.volume;
  region.surface = node(*std::min_element(boundary.nodes.begin(), boundary.nodes.end(), [&](auto a, auto b) {
    return (node(a) - region.centre).squaredNorm() < (node(b) - region.centre).squaredNorm();
  }));
  return region;
}

}  // namespace

Report makeReport(const std::string& file, const mesh::TetMesh& mesh, const mesh::BoundarySurface& boundary,
                  std::vector<std::string> notes) {
  Report report{file,
                mesh::statisticsOf(mesh, boundary),
                mesh.isQuadratic() ? 2 : 1,
                groupSize(mesh, "fixed"),
                groupSize(mesh, "accessible"),
                {},
                std::move(notes)};
  for (const auto& [name, tetrahedra] : mesh.regions)
    if (!tetrahedra.empty()) report.regions[name] = regionOf(mesh, boundary, tetrahedra);
  return report;
}

program::Json toJson(const Report& report) {
  const auto& s = report.statistics;
  program::Json regions = program::Json::object();
  for (const auto& [name, region] : report.regions)
    regions[name] = {{"tetrahedra", region.tetrahedra},
                     {"volume", region.volume},
                     {"centre", region.centre},
                     {"nearest_surface", region.surface}};
  return {{"file", report.file},
          {"element_order", report.element_order},
          {"nodes", s.nodes},
          {"corners", s.corners},
          {"tetrahedra", s.tetrahedra},
          {"surface_nodes", s.surface_nodes},
          {"surface_corners", s.surface_corners},
          {"surface_triangles", s.surface_triangles},
          {"fixed_nodes", report.fixed_nodes},
          {"accessible_nodes", report.accessible_nodes},
          {"bounding_box", {{"min", s.box_min}, {"max", s.box_max}}},
          {"volume", s.volume},
          {"regions", regions},
          {"worst_quality", s.worst_quality},
          {"worst_tetrahedron", s.worst_tetrahedron},
          {"mean_edge", s.mean_edge},
          {"median_surface_edge", s.median_surface_edge},
          {"warnings", report.notes}};
}

void print(std::ostream& out, const Report& report) {
  const auto& s = report.statistics;
  char line[200];
  out << "wrote            " << report.file << '\n';
  out << "nodes            " << s.nodes << ", " << s.surface_nodes
      << " on the surface: " << report.fixed_nodes << " fixed, " << report.accessible_nodes
      << " accessible\n";
  if (report.element_order == 2)
    out << "corners          " << s.corners << ", " << s.surface_corners << " on the surface\n";
  out << "tetrahedra       " << s.tetrahedra << (report.element_order == 2 ? " of ten nodes, " : ", ")
      << s.surface_triangles << " boundary triangles\n";
  for (const auto& [name, region] : report.regions)
    out << "region           " << name << ": " << region.tetrahedra << " tetrahedra, centre "
        << inWords(region.centre) << " m, " << inMillimetres((region.centre - region.surface).norm())
        << " mm from the surface at " << inWords(region.surface) << " m\n";
  out << "bounding box     " << inWords(s.box_min) << " to " << inWords(s.box_max) << " m, size "
      << inWords(s.box_max - s.box_min) << " m\n";
  std::snprintf(line, sizeof line, "volume           %.6g m^3\n", s.volume);
  out << line;
  std::snprintf(line, sizeof line, "worst quality    %.4f (tetrahedron %lld; 1 is regular, 0 flat)\n",
                s.worst_quality, static_cast<long long>(s.worst_tetrahedron));
  out << line;
  std::snprintf(line, sizeof line, "edges            mean %.4g m, median on the surface %.4g m\n",
                s.mean_edge, s.median_surface_edge);
  out << line;
  for (const auto& note : report.notes) out << "warning: " << note << '\n';
}

}  // namespace palpate::organ
