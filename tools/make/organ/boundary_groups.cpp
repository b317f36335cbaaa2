// SPDX-License-Identifier: Apache-2.0
#include "tools/make/organ/boundary_groups.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <vector>

#include "tools/mesh/checks.h"
#include "tools/mesh/mesh_error.h"

namespace palpate::organ {
namespace {

using mesh::MeshError;
using Nodes = std::vector<std::int32_t>;

std::vector<double> numbers(std::string_view list, const std::string& text) {
  std::vector<double> values;
  for (const char* at = list.data(); at <= list.data() + list.size();) {
    const char* const end = std::find(at, list.data() + list.size(), ',');
    const auto [stop, error] = std::from_chars(at, end, values.emplace_back());
    if (error != std::errc{} || stop != end || !std::isfinite(values.back())) {
      throw MeshError("--fixed " + text + ": '" + std::string(at, end) + "' is not a number");
    }
    at = end + 1;
  }
  return values;
}

FixedRule lowestRule(std::string_view list, const std::string& text) {
  const std::vector<double> values = numbers(list, text);
  if (values.size() != 1 || !(values[0] > 0 && values[0] < 1)) {
    throw MeshError("--fixed " + text + ": the fraction must be one number between 0 and 1");
  }
  FixedRule rule;
  rule.kind = FixedRule::Kind::kLowestZ;
  rule.fraction = values[0];
  return rule;
}

FixedRule boxRule(std::string_view list, const std::string& text) {
  const std::vector<double> v = numbers(list, text);
  if (v.size() != 6)
    throw MeshError("--fixed " + text + ": a box takes six numbers, not " + std::to_string(v.size()));
  FixedRule rule;
  rule.kind = FixedRule::Kind::kBox;
  rule.box = Eigen::AlignedBox3d(Eigen::Vector3d(v[0], v[1], v[2]), Eigen::Vector3d(v[3], v[4], v[5]));
  if (rule.box.isEmpty())
    throw MeshError("--fixed " + text + ": the box's second corner must not be below its first");
  return rule;
}

Nodes groupNodes(const mesh::TetMesh& mesh, const std::string& name) {
  const auto found = mesh.groups.find(name);
  if (found != mesh.groups.end()) return found->second;
  std::string known;
  for (const auto& [group, nodes] : mesh.groups) known += (known.empty() ? "" : ", ") + group;
  throw MeshError("--fixed group:" + name + ": there is no such group; " +
                  (known.empty() ? "the file has none" : "the file has " + known));
}

Nodes lowestNodes(const mesh::TetMesh& mesh, const mesh::BoundarySurface& boundary, double fraction) {
  Nodes nodes = boundary.nodes;
  const auto z = [&](std::int32_t node) { return mesh.nodes[static_cast<std::size_t>(node)].z(); };
  // Stable, so that nodes of equal height are taken in the file's order.
  std::stable_sort(nodes.begin(), nodes.end(), [&](auto a, auto b) { return z(a) < z(b); });
  nodes.resize(static_cast<std::size_t>(std::lround(fraction * static_cast<double>(nodes.size()))));
  std::sort(nodes.begin(), nodes.end());
  return nodes;
}

Nodes nodesInBox(const mesh::TetMesh& mesh, const mesh::BoundarySurface& boundary,
                 const Eigen::AlignedBox3d& box) {
  Nodes nodes;
  for (const auto node : boundary.nodes) {
    if (box.contains(mesh.nodes[static_cast<std::size_t>(node)])) nodes.push_back(node);
  }
  return nodes;
}

Nodes fixedNodes(const mesh::TetMesh& mesh, const mesh::BoundarySurface& boundary, const FixedRule& rule) {
  switch (rule.kind) {
    case FixedRule::Kind::kGroup:
      return groupNodes(mesh, rule.group);
    case FixedRule::Kind::kLowestZ:
      return lowestNodes(mesh, boundary, rule.fraction);
    case FixedRule::Kind::kBox:
      return nodesInBox(mesh, boundary, rule.box);
    case FixedRule::Kind::kKeep:
      break;
  }
  const auto found = mesh.groups.find("fixed");
  return found == mesh.groups.end() ? Nodes{} : found->second;
}

// What the file calls accessible may leave out more than the clamp, a rim around it for one.
Nodes accessibleNodes(const mesh::TetMesh& mesh, const mesh::BoundarySurface& boundary, const Nodes& fixed) {
  Nodes accessible;
  std::set_difference(boundary.nodes.begin(), boundary.nodes.end(), fixed.begin(), fixed.end(),
                      std::back_inserter(accessible));
  if (accessible.empty())
    throw MeshError("all " + std::to_string(boundary.nodes.size()) + " surface nodes are fixed");
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

FixedRule parseFixedRule(const std::string& text) {
  const auto colon = text.find(':');
  const std::string kind = text.substr(0, colon);
  const std::string_view rest =
      std::string_view(text).substr(colon == std::string::npos ? text.size() : colon + 1);
  if (kind == "lowest-z" && colon != std::string::npos) return lowestRule(rest, text);
  if (kind == "box" && colon != std::string::npos) return boxRule(rest, text);
  if (kind != "group" || rest.empty()) {
    throw MeshError("--fixed " + text + ": expected group:NAME, lowest-z:FRACTION or box:x0,y0,z0,x1,y1,z1");
  }
  FixedRule rule;
  rule.kind = FixedRule::Kind::kGroup;
  rule.group = rest;
  return rule;
}

void setBoundaryGroups(mesh::TetMesh& mesh, const mesh::BoundarySurface& boundary, const FixedRule& rule) {
  const Nodes fixed = fixedNodes(mesh, boundary, rule);
  if (!fixed.empty() || rule.kind != FixedRule::Kind::kKeep) {
    mesh.groups["fixed"] = fixed;
    mesh::checkHeld(mesh, "fixed");
  }
  Nodes accessible = accessibleNodes(mesh, boundary, fixed);
  mesh.groups.clear();
  if (!fixed.empty()) mesh.groups["fixed"] = fixed;
  mesh.groups["accessible"] = std::move(accessible);
  for (const char* name : {"fixed", "accessible"}) mesh.regions.erase(name);  // they name nodes, no tissue
}

std::vector<std::string> groupsNotKept(const mesh::TetMesh& mesh, const FixedRule& rule) {
  std::vector<std::string> names;
  for (const auto& [name, nodes] : mesh.groups) {
    const bool whole = name == "organ" && nodes.size() == mesh.nodes.size();  // writeMsh() adds it again
    const bool replaced = name == "fixed" && rule.kind != FixedRule::Kind::kKeep && rule.group != name;
    const bool kept =
        name == "fixed" || name == "accessible" || name == rule.group || mesh.regions.contains(name);
    if (replaced || !(kept || whole)) names.push_back(name);
  }
  return names;
}

}  // namespace palpate::organ
