// SPDX-License-Identifier: Apache-2.0
#include "tools/examine/feel/press_places.h"

#include <algorithm>
#include <cstdint>
#include <span>

#include "tools/examine/feel/surface_path.h"

namespace palpate::feel {
namespace {

// As palpate-device chooses among them.
std::vector<int> candidates(const MetaModel& model) {
  const std::vector<std::uint8_t> accessible = model.accessibleNodes();
  std::vector<std::uint8_t> inner = accessible;
  const std::span<const std::int32_t> corners = model.view().surface_triangles;
  for (std::size_t t = 0; t < corners.size(); t += 3) {
    const auto triangle = corners.subspan(t, 3);
    if (std::any_of(triangle.begin(), triangle.end(),
                    [&](std::int32_t node) { return accessible[static_cast<std::size_t>(node)] == 0; }))
      for (const std::int32_t node : triangle) inner[static_cast<std::size_t>(node)] = 0;
  }
  if (std::find(inner.begin(), inner.end(), 1) == inner.end()) inner = accessible;
  std::vector<int> nodes;
  for (int node = 0; node < model.surface().nodes(); ++node)
    if (inner[static_cast<std::size_t>(node)] != 0) nodes.push_back(node);
  return nodes;
}

}  // namespace

std::vector<PressPlace> pressPlaces(const MetaModel& model) {
  struct Node {
    ContactPoint s;
    double height, stiffness;
    int node;
  };
  std::vector<Node> nodes;
  for (const int node : candidates(model)) {
    const ContactPoint s = model.surface().atNode(node);
    nodes.push_back({s, model.surface().position(s).z(), normalStiffness(model, s), node});
  }
  if (nodes.empty()) return {};
  const Node highest = *std::max_element(nodes.begin(), nodes.end(),
                                         [](const Node& a, const Node& b) { return a.height < b.height; });
  std::stable_sort(nodes.begin(), nodes.end(),
                   [](const Node& a, const Node& b) { return a.stiffness < b.stiffness; });
  std::vector<PressPlace> places{{"highest", highest.s}};
  std::vector<int> taken{highest.node};
  const auto add = [&](std::string_view name, const Node& node) {
    if (std::find(taken.begin(), taken.end(), node.node) != taken.end()) return;
    places.push_back({name, node.s});
    taken.push_back(node.node);
  };
  add("median", nodes[nodes.size() / 2]);
  add("softest", nodes.front());
  add("stiffest", nodes.back());
  return places;
}

}  // namespace palpate::feel
