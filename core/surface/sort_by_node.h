// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

namespace palpate {

/// Sorts by a node that each item has, below `nodes`, then by operator<: one pass over all, then each node's few by themselves.
/// @param node_of  of an item  @return [nodes + 1] where each node's items begin. Cost O(N + nodes) for few items each.
template <class Item, class NodeOf>
std::vector<std::size_t> sortByNode(std::vector<Item>& items, std::size_t nodes, const NodeOf& node_of) {
  std::vector<std::size_t> first(nodes + 1, 0);
  for (const Item& item : items) ++first[node_of(item) + 1];
  for (std::size_t i = 0; i < nodes; ++i) first[i + 1] += first[i];
  std::vector<std::size_t> next(first.begin(), first.end() - 1);
  std::vector<Item> sorted(items.size());
  for (const Item& item : items) sorted[next[node_of(item)]++] = item;
  for (std::size_t i = 0; i < nodes; ++i) {
    const std::span<Item> own = std::span(sorted).subspan(first[i], first[i + 1] - first[i]);
    std::sort(own.begin(), own.end());
  }
  items = std::move(sorted);
  return first;
}

}  // namespace palpate
