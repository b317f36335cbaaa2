// SPDX-License-Identifier: Apache-2.0
#include "tools/solver/series/node_order.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace palpate::solver {

NodeOrder::NodeOrder(const FeModel& model, const Cholesky& factor) {
  const auto at = [](int i) { return static_cast<std::size_t>(i); };
  std::vector<int> node_of(at(model.dofCount()));
  for (int node = 0; node < model.nodeCount(); ++node)
    if (model.isFree(node))
      for (int c = 0; c < 3; ++c) node_of[at(model.dof(node) + c)] = node;
  place.assign(at(model.nodeCount()), -1);
  std::int32_t next = 0;
  for (const int dof : factor.order()) {
    const int node = node_of[at(dof)];
    if (place[at(node)] < 0) place[at(node)] = next++;
    rows.push_back({at(place[at(node)]), at(dof - model.dof(node))});
  }
  row_of.resize(at(next));
  for (std::size_t row = 0; row < rows.size(); ++row) row_of[rows[row].place][rows[row].c] = row;
  for (std::int32_t& clamped : place)
    if (clamped < 0) clamped = next++;
}

FeModel::Points NodeOrder::sorted(const FeModel::Points& of_the_mesh) const {
  FeModel::Points points = of_the_mesh;
  std::visit(
      [this](auto& all) {
        for (auto& point : all)
          for (std::int32_t& node : point.nodes) node = place[static_cast<std::size_t>(node)];
        const auto key = [](const auto& point) {
          return std::pair(point.law.index(), *std::min_element(point.nodes.begin(), point.nodes.end()));
        };
        std::stable_sort(all.begin(), all.end(),
                         [&](const auto& l, const auto& r) { return key(l) < key(r); });
      },
      points);
  return points;
}

double pointLength(const FeModel::Points& points) {
  return std::visit(
      [](const auto& all) {
        double volume = 0.0;
        for (const auto& point : all) volume += point.weight;
        return std::exp2(std::round(std::log2(std::cbrt(volume / static_cast<double>(all.size())))));
      },
      points);
}

}  // namespace palpate::solver
