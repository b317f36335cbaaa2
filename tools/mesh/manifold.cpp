// SPDX-License-Identifier: Apache-2.0
#include "tools/mesh/manifold.h"

#include <algorithm>
#include <utility>

namespace palpate::mesh {
namespace {

using Namer = std::function<std::string(std::int32_t)>;

// An edge as its triangle passes it.
struct HalfEdge {
  std::int32_t low, high;  // vertices, ascending
  bool forward;            // passed from low to high
  std::int32_t triangle;
};

std::vector<HalfEdge> sortedHalfEdges(const std::vector<Triangle>& triangles) {
  std::vector<HalfEdge> edges;
  edges.reserve(3 * triangles.size());
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    for (std::size_t i = 0; i < 3; ++i) {
      const auto a = triangles[t][i];
      const auto b = triangles[t][(i + 1) % 3];
      edges.push_back({std::min(a, b), std::max(a, b), a < b, static_cast<std::int32_t>(t)});
    }
  }
  std::sort(edges.begin(), edges.end(), [](const HalfEdge& x, const HalfEdge& y) {
    if (x.low != y.low) return x.low < y.low;
    return x.high != y.high ? x.high < y.high : x.triangle < y.triangle;
  });
  return edges;
}

std::optional<std::string> edgeDefect(const std::vector<HalfEdge>& edges, const Namer& vertexName,
                                      const Namer& triangleName) {
  for (std::size_t i = 0; i < edges.size();) {
    std::size_t end = i;
    while (end < edges.size() && edges[end].low == edges[i].low && edges[end].high == edges[i].high) ++end;
    const auto where = [&] {
      return "edge between " + vertexName(edges[i].low) + " and " + vertexName(edges[i].high);
    };
    if (end - i != 2) {
      return where() + " lies in " + std::to_string(end - i) + " triangle" + (end - i == 1 ? "" : "s") +
             " instead of 2, one of them " + triangleName(edges[i].triangle);
    }
    if (edges[i].forward == edges[i + 1].forward) {
      return where() + " is passed in the same direction by " + triangleName(edges[i].triangle) + " and " +
             triangleName(edges[i + 1].triangle);
    }
    i = end;
  }
  return std::nullopt;
}

// A triangle as a vertex sees it.
struct Spoke {
  std::int32_t next, previous, triangle;

  [[nodiscard]] bool sharesAnEdgeWith(const Spoke& other) const {
    return next == other.next || next == other.previous || previous == other.next ||
           previous == other.previous;
  }
};

// One triangle of each fan. `spokes` ascend by triangle.
std::vector<std::int32_t> fansOf(const std::vector<Spoke>& spokes) {
  std::vector<std::int32_t> fans;
  std::vector<bool> met(spokes.size(), false);
  for (std::size_t first = 0; first < spokes.size(); ++first) {
    if (met[first]) continue;
    fans.push_back(spokes[first].triangle);
    met[first] = true;
    for (std::vector<std::size_t> open{first}; !open.empty();) {
      const Spoke& at = spokes[open.back()];
      open.pop_back();
      for (std::size_t i = first + 1; i < spokes.size(); ++i) {
        if (met[i] || !at.sharesAnEdgeWith(spokes[i])) continue;
        met[i] = true;
        open.push_back(i);
      }
    }
  }
  return fans;
}

}  // namespace

std::vector<JoinedFans> joinedFans(const std::vector<Triangle>& triangles, std::size_t vertex_count) {
  std::vector<std::vector<Spoke>> around(vertex_count);
  for (std::size_t t = 0; t < triangles.size(); ++t)
    for (std::size_t i = 0; i < 3; ++i)
      around[static_cast<std::size_t>(triangles[t][i])].push_back(
          {triangles[t][(i + 1) % 3], triangles[t][(i + 2) % 3], static_cast<std::int32_t>(t)});
  std::vector<JoinedFans> joined;
  for (std::size_t v = 0; v < vertex_count; ++v) {
    std::vector<std::int32_t> fans = fansOf(around[v]);
    if (fans.size() > 1) joined.push_back({static_cast<std::int32_t>(v), std::move(fans)});
  }
  return joined;
}

std::optional<std::string> manifoldDefect(const std::vector<Triangle>& triangles, std::size_t vertex_count,
                                          const Namer& vertexName, const Namer& triangleName) {
  auto defect = edgeDefect(sortedHalfEdges(triangles), vertexName, triangleName);
  if (defect) return defect;
  const std::vector<JoinedFans> joined = joinedFans(triangles, vertex_count);
  if (joined.empty()) return std::nullopt;
  return vertexName(joined.front().vertex) + " joins several fans of triangles, one of them at " +
         triangleName(joined.front().triangles.front());
}

}  // namespace palpate::mesh
