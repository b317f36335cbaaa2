// SPDX-License-Identifier: Apache-2.0
#include "tools/make/organ/boundary_groups.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <iterator>
#include <numbers>
#include <vector>

#include "tools/mesh/checks.h"
#include "tools/mesh/mesh_error.h"
#include "tools/mesh/surface_solids.h"
#include "tools/program/exit_code.h"

namespace palpate::organ {
namespace {

using mesh::MeshError;
using program::UsageError;
using Nodes = std::vector<std::int32_t>;

std::vector<double> numbers(std::string_view list, const std::string& text) {
  std::vector<double> values;
  for (const char* at = list.data(); at <= list.data() + list.size();) {
    const char* const end = std::find(at, list.data() + list.size(), ',');
    const auto [stop, error] = std::from_chars(at, end, values.emplace_back());
    if (error != std::errc{} || stop != end || !std::isfinite(values.back())) {
      throw UsageError("--fixed " + text + ": '" + std::string(at, end) + "' is not a number");
    }
    at = end + 1;
  }
  return values;
}

FixedRule lowestRule(std::string_view list, const std::string& text) {
  const std::vector<double> values = numbers(list, text);
  if (values.size() != 1 || !(values[0] > 0 && values[0] < 1)) {
    throw UsageError("--fixed " + text + ": the fraction must be one number between 0 and 1");
  }
  FixedRule rule;
  rule.kind = FixedRule::Kind::kLowestZ;
  rule.fraction = values[0];
  return rule;
}

FixedRule boxRule(std::string_view list, const std::string& text) {
  const std::vector<double> v = numbers(list, text);
  if (v.size() != 6)
    throw UsageError("--fixed " + text + ": a box takes six numbers, not " + std::to_string(v.size()));
  FixedRule rule;
  rule.kind = FixedRule::Kind::kBox;
  rule.box = Eigen::AlignedBox3d(Eigen::Vector3d(v[0], v[1], v[2]), Eigen::Vector3d(v[3], v[4], v[5]));
  if (rule.box.isEmpty())
    throw UsageError("--fixed " + text + ": the box's second corner must not be below its first");
  return rule;
}

FixedRule sideRule(const std::string& text) {
  FixedRule rule;
  rule.kind = FixedRule::Kind::kSide;
  rule.normal = Eigen::Vector3d::Zero();
  rule.normal[text[1] - 'x'] = text[0] == '-' ? -1 : 1;
  return rule;
}

FixedRule normalRule(std::string_view list, const std::string& text) {
  constexpr double kDegrees = 30;
  const std::vector<double> v = numbers(list, text);
  if (v.size() != 3 && v.size() != 4)
    throw UsageError("--fixed " + text + ": a normal takes three numbers, and degrees if wanted, not " +
                     std::to_string(v.size()));
  const double degrees = v.size() == 4 ? v[3] : kDegrees;
  if (!(degrees > 0 && degrees <= 90))
    throw UsageError("--fixed " + text + ": the angle must be above 0 and at most 90 degrees");
  FixedRule rule;
  rule.kind = FixedRule::Kind::kNormal;
  rule.normal = Eigen::Vector3d(v[0], v[1], v[2]);
  if (!(rule.normal.norm() > 0)) throw UsageError("--fixed " + text + ": the normal has no length");
  rule.normal.normalize();
  rule.angle = degrees * std::numbers::pi / 180;
  return rule;
}

bool isSide(const std::string& text) {
  return text.size() == 2 && (text[0] == '-' || text[0] == '+') && text[1] >= 'x' && text[1] <= 'z';
}

Nodes groupNodes(const mesh::TetMesh& mesh, const std::string& name) {
  const auto found = mesh.groups.find(name);
  if (found != mesh.groups.end()) return found->second;
  refuseUnknownGroup(name, mesh.groups);
}

// The outer part of a boundary; the others bound cavities.
struct OuterSurface {
  std::vector<std::array<std::int32_t, 3>> triangles;  // of nodes of the mesh
  Nodes nodes;                                         // ascending
};

OuterSurface outerSurface(const mesh::TetMesh& mesh, const mesh::BoundarySurface& boundary) {
  mesh::TriangleSurface surface;
  for (const auto node : boundary.nodes)
    surface.vertices.push_back(mesh.nodes[static_cast<std::size_t>(node)]);
  surface.triangles = boundary.triangles;
  const std::vector<std::size_t> parts = mesh::partsOf(surface);
  std::vector<Eigen::AlignedBox3d> boxes(parts.empty() ? 0
                                                       : *std::max_element(parts.begin(), parts.end()) + 1);
  for (std::size_t t = 0; t < parts.size(); ++t)
    for (const auto v : surface.triangles[t])
      boxes[parts[t]].extend(surface.vertices[static_cast<std::size_t>(v)]);
  const auto largest = std::max_element(boxes.begin(), boxes.end(), [](const auto& a, const auto& b) {
    return a.diagonal().norm() < b.diagonal().norm();
  });
  const auto outer = static_cast<std::size_t>(largest - boxes.begin());
  OuterSurface result;
  for (std::size_t t = 0; t < parts.size(); ++t) {
    if (parts[t] != outer) continue;
    std::array<std::int32_t, 3> corners{};
    for (std::size_t k = 0; k < 3; ++k)
      corners[k] = boundary.nodes[static_cast<std::size_t>(surface.triangles[t][k])];
    result.triangles.push_back(corners);
    result.nodes.insert(result.nodes.end(), corners.begin(), corners.end());
  }
  std::sort(result.nodes.begin(), result.nodes.end());
  result.nodes.erase(std::unique(result.nodes.begin(), result.nodes.end()), result.nodes.end());
  return result;
}

Nodes lowestNodes(const mesh::TetMesh& mesh, const OuterSurface& outer, double fraction) {
  Nodes nodes = outer.nodes;
  const auto z = [&](std::int32_t node) { return mesh.nodes[static_cast<std::size_t>(node)].z(); };
  // Stable, so that nodes of equal height are taken in the file's order.
  std::stable_sort(nodes.begin(), nodes.end(), [&](auto a, auto b) { return z(a) < z(b); });
  nodes.resize(static_cast<std::size_t>(std::lround(fraction * static_cast<double>(nodes.size()))));
  return nodes;
}

Nodes nodesInBox(const mesh::TetMesh& mesh, const OuterSurface& outer, const Eigen::AlignedBox3d& box) {
  Nodes nodes;
  for (const auto node : outer.nodes) {
    if (box.contains(mesh.nodes[static_cast<std::size_t>(node)])) nodes.push_back(node);
  }
  return nodes;
}

bool faces(const Eigen::Vector3d& normal, const FixedRule& rule) {
  const double cosine = normal.dot(rule.normal);
  if (rule.kind == FixedRule::Kind::kNormal) return cosine >= std::cos(rule.angle) - 1e-12;
  return cosine >= normal.cwiseAbs().maxCoeff();
}

Nodes facingNodes(const mesh::TetMesh& mesh, const OuterSurface& outer, const FixedRule& rule) {
  Nodes nodes;
  for (const auto& t : outer.triangles) {
    const auto at = [&](std::size_t k) { return mesh.nodes[static_cast<std::size_t>(t[k])]; };
    if (faces((at(1) - at(0)).cross(at(2) - at(0)).normalized(), rule))
      nodes.insert(nodes.end(), t.begin(), t.end());
  }
  return nodes;
}

Nodes nodesOf(const mesh::TetMesh& mesh, const OuterSurface& outer, const FixedRule& rule) {
  switch (rule.kind) {
    case FixedRule::Kind::kGroup:
      return groupNodes(mesh, rule.group);
    case FixedRule::Kind::kLowestZ:
      return lowestNodes(mesh, outer, rule.fraction);
    case FixedRule::Kind::kBox:
      return nodesInBox(mesh, outer, rule.box);
    case FixedRule::Kind::kSide:
    case FixedRule::Kind::kNormal:
      break;
  }
  return facingNodes(mesh, outer, rule);
}

// What the file calls accessible may leave out more than the clamp, a rim around it for one.
Nodes accessibleNodes(const mesh::TetMesh& mesh, const Nodes& outer, const Nodes& fixed) {
  Nodes accessible;
  std::set_difference(outer.begin(), outer.end(), fixed.begin(), fixed.end(), std::back_inserter(accessible));
  if (accessible.empty())
    throw UsageError("--fixed: all " + std::to_string(outer.size()) + " surface nodes are fixed");
  const auto own = mesh.groups.find("accessible");
  if (own == mesh.groups.end()) return accessible;
  Nodes both;
  std::set_intersection(accessible.begin(), accessible.end(), own->second.begin(), own->second.end(),
                        std::back_inserter(both));
  if (!both.empty()) return both;
  throw MeshError("group 'accessible': none of its " + std::to_string(own->second.size()) +
                  " nodes is a surface node that is not fixed");
}

}  // namespace

void refuseUnknownGroup(const std::string& name,
                        const std::map<std::string, std::vector<std::int32_t>>& known) {
  std::string names;
  for (const auto& [group, members] : known) names += (names.empty() ? "" : ", ") + group;
  throw UsageError("--fixed group:" + name + ": there is no such group; " +
                   (names.empty() ? "the file has none" : "the file has " + names));
}

FixedRule parseFixedRule(const std::string& text) {
  const auto colon = text.find(':');
  const std::string kind = text.substr(0, colon);
  const std::string_view rest =
      std::string_view(text).substr(colon == std::string::npos ? text.size() : colon + 1);
  FixedRule rule;
  if (isSide(text)) {
    rule = sideRule(text);
  } else if (kind == "lowest-z" && colon != std::string::npos) {
    rule = lowestRule(rest, text);
  } else if (kind == "box" && colon != std::string::npos) {
    rule = boxRule(rest, text);
  } else if (kind == "normal" && colon != std::string::npos) {
    rule = normalRule(rest, text);
  } else if (kind == "group" && !rest.empty()) {
    rule.group = rest;
  } else {
    throw UsageError("--fixed " + text +
                     ": expected group:NAME, lowest-z:FRACTION, box:x0,y0,z0,x1,y1,z1, a side such as -x, or "
                     "normal:x,y,z[,degrees]");
  }
  rule.text = text;
  return rule;
}

Nodes fixedNodes(const mesh::TetMesh& mesh, const mesh::BoundarySurface& boundary, const FixedRules& rules) {
  if (rules.empty()) {
    const auto found = mesh.groups.find("fixed");
    return found == mesh.groups.end() ? Nodes{} : found->second;
  }
  const OuterSurface outer = outerSurface(mesh, boundary);
  Nodes fixed;
  for (const FixedRule& rule : rules) {
    const Nodes nodes = nodesOf(mesh, outer, rule);
    if (nodes.empty() && rules.size() > 1) throw UsageError("--fixed " + rule.text + " holds no node");
    fixed.insert(fixed.end(), nodes.begin(), nodes.end());
  }
  std::sort(fixed.begin(), fixed.end());
  fixed.erase(std::unique(fixed.begin(), fixed.end()), fixed.end());
  return fixed;
}

void setBoundaryGroups(mesh::TetMesh& mesh, const mesh::BoundarySurface& boundary, const FixedRules& rules) {
  const Nodes fixed = fixedNodes(mesh, boundary, rules);
  if (!fixed.empty() || !rules.empty()) {
    mesh.groups["fixed"] = fixed;
    const auto check = [&] { mesh::checkHeld(mesh, "fixed"); };
    rules.empty() ? check() : program::orUsageError(check, "--fixed: ");
  }
  Nodes accessible = accessibleNodes(mesh, outerSurface(mesh, boundary).nodes, fixed);
  mesh.groups.clear();
  if (!fixed.empty()) mesh.groups["fixed"] = fixed;
  mesh.groups["accessible"] = std::move(accessible);
  for (const char* name : {"fixed", "accessible"}) mesh.regions.erase(name);  // they name nodes, no tissue
}

std::vector<std::string> groupsNotKept(const mesh::TetMesh& mesh, const FixedRules& rules) {
  const auto isHeld = [&](const std::string& name) {
    return std::any_of(rules.begin(), rules.end(), [&](const FixedRule& rule) {
      return rule.kind == FixedRule::Kind::kGroup && rule.group == name;
    });
  };
  std::vector<std::string> names;
  for (const auto& [name, nodes] : mesh.groups) {
    const bool whole = name == "organ" && nodes.size() == mesh.nodes.size();  // writeMsh() adds it again
    const bool replaced = name == "fixed" && !rules.empty() && !isHeld(name);
    const bool kept = name == "fixed" || name == "accessible" || isHeld(name) || mesh.regions.contains(name);
    if (replaced || !(kept || whole)) names.push_back(name);
  }
  return names;
}

}  // namespace palpate::organ
