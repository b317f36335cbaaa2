// SPDX-License-Identifier: Apache-2.0
#include "core/surface/contact_patches.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "core/base/index.h"

namespace palpate {

namespace {

constexpr double kReach = 3.0;  // of a

/// exp(-r^2 / 2 a^2) t(r / 3 a) and its derivative by r^2. @param square  r^2, m^2
struct Fall {
  double value{0.0}, slope{0.0};
};
Fall fallAt(double square, double a) noexcept PALPATE_NONBLOCKING {
  constexpr double kFlat = 0.6;  // of the reach
  if (square >= kReach * kReach * a * a) return {};
  const double x = std::sqrt(std::max(square, 0.0)) / (kReach * a);
  const double gauss = std::exp(-0.5 * square / (a * a));
  if (x <= kFlat) return {gauss, -0.5 / (a * a) * gauss};
  const double z = (x - kFlat) / (1.0 - kFlat);
  const double taper = 1.0 - z * z * z * (10.0 + z * (-15.0 + 6.0 * z));
  const double by_z = -30.0 * z * z * (1.0 - z) * (1.0 - z);
  const double by_square = by_z / (1.0 - kFlat) / (2.0 * x * kReach * kReach * a * a);
  return {gauss * taper, gauss * (by_square - 0.5 / (a * a) * taper)};
}

/// How far from each corner its faces reach, m.
std::vector<double> longestEdges(const SurfaceGraph& graph) {
  std::vector<double> longest(index(graph.nodes()), 0.0);
  for (std::int32_t f = 0; f < graph.faces(); ++f)
    for (const std::int32_t from : graph.face(f))
      for (const std::int32_t to : graph.face(f))
        longest[index(from)] =
            std::max(longest[index(from)], (graph.position(to) - graph.position(from)).norm());
  return longest;
}

/// A hostile file's patches would fill the memory and take all day, those over fixed nodes too.
void requireFew(std::size_t reached, std::size_t together, double a) {
  if (reached <= ContactPatches::kMostNodes && together <= ContactPatches::kMostTogether) return;
  throw std::invalid_argument(
      "patch_radius is " + std::to_string(a) + " m, expected one of patches with at most " +
      std::to_string(ContactPatches::kMostNodes) + " nodes, found " + std::to_string(reached) +
      ", and all together " + std::to_string(ContactPatches::kMostTogether) + ", found " +
      std::to_string(together));
}

}  // namespace

ContactPatches::ContactPatches(const SurfaceGraph& graph, std::span<const std::uint8_t> free, double a,
                               std::span<const std::int32_t> centres)
    : a_(a), load_(graph.loadAreas()), free_(free.begin(), free.end()), near_(free.size()) {
  for (std::int32_t f = 0; f < graph.faces(); ++f) {
    const std::span<const std::int32_t> node = graph.face(f);
    triangles_.insert(triangles_.end(), node.begin(), node.end());
    std::array<double, 3> squares{};
    for (std::size_t k = 0; k < 3; ++k)
      squares[k] = (graph.position(node[(k + 1) % 3]) - graph.position(node[(k + 2) % 3])).squaredNorm();
    edges_.push_back(squares);
  }
  findNear(graph, centres);
  for (const std::vector<Near>& list : lists_) entries_ += list.size();
  for (const std::span<const Near> near : near_) most_ = std::max(most_, near.size());
}

void ContactPatches::findNear(const SurfaceGraph& graph, std::span<const std::int32_t> centres) {
  constexpr std::size_t kPiece = (1U << 20U) / sizeof(Near);  // one list would be copied as it grows
  static_assert(kPiece >= kMostNodes);
  const std::vector<double> longest = longestEdges(graph);
  SurfaceFront front(graph);
  std::size_t together = 0;
  for (const std::int32_t centre : centres) {
    const std::int32_t t = graph.trianglesOf(centre).front();
    ContactPoint s{t, {}};
    for (std::size_t k = 0; k < 3; ++k) s.barycentric[k] = graph.triangle(t)[k] == centre ? 1.0 : 0.0;
    const auto& reached = front.from(s, kReach * a_ + longest[index(centre)]);
    requireFew(reached.size(), together += reached.size(), a_);
    if (lists_.empty() || lists_.back().size() + reached.size() > kPiece)
      lists_.emplace_back().reserve(std::min(kPiece, centres.size() * kMostNodes));
    std::vector<Near>& list = lists_.back();
    const std::size_t first = list.size();
    for (const auto& [node, r] : reached)
      if (load_[index(node)] > 0.0) list.push_back({node, static_cast<float>(r * r)});
    const std::span<Near> own = std::span(list).subspan(first);
    std::sort(own.begin(), own.end(), [](const Near& l, const Near& r) { return l.node < r.node; });
    near_[index(centre)] = own;
  }
}

PatchNodes ContactPatches::room() const {
  PatchNodes patch;
  patch.node.resize(most_);
  patch.weight.resize(most_);
  patch.slope.resize(most_);
  return patch;
}

void ContactPatches::markNear(std::int32_t centre, std::span<std::uint8_t> near) const {
  for (const Near& entry : nearTo(centre))
    if (free_[index(entry.node)] != 0 && load_[index(entry.node)] > 0.0) near[index(entry.node)] = 1;
}

void ContactPatches::at(const ContactPoint& s, bool slopes,
                        PatchNodes& patch) const noexcept PALPATE_NONBLOCKING {
  patch.count = 0;
  patch.free_share = 0.0;
  if (s.triangle < 0 || index(s.triangle) >= edges_.size()) return;
  const std::int32_t* const corner = triangles_.data() + 3 * index(s.triangle);
  const std::array<double, 3>& edge = edges_[index(s.triangle)];
  const std::array<double, 3>& l = s.barycentric;
  // Nodes are ascending in each list, so one pass meets those that all corners with a part in s have. What is added to the
  // squares is the same for all: lambda_b lambda_c times the edge's square.
  const double within = l[1] * l[2] * edge[0] + l[2] * l[0] * edge[1] + l[0] * l[1] * edge[2];
  const Vec3 within_slope(l[1] * edge[2] + l[2] * edge[1], l[0] * edge[2] + l[2] * edge[0],
                          l[0] * edge[1] + l[1] * edge[0]);
  std::array<std::span<const Near>, 3> list;
  for (std::size_t k = 0; k < 3; ++k) list[k] = nearTo(corner[k]);
  std::array<std::size_t, 3> next{};
  const std::size_t lead = l[0] > 0.0 ? 0 : l[1] > 0.0 ? 1 : 2;
  double total = 0.0, sum = 0.0;
  Vec3 sum_slope = Vec3::Zero();
  for (const Near& near : list[lead]) {
    Vec3 square = Vec3::Constant(double(near.square));  // r_ib^2 by corner
    bool everywhere = true;
    for (std::size_t k = 0; k < 3; ++k) {
      if (k == lead) continue;
      while (next[k] < list[k].size() && list[k][next[k]].node < near.node) ++next[k];
      const bool has = next[k] < list[k].size() && list[k][next[k]].node == near.node;
      if (has)
        square[Eigen::Index(k)] = double(list[k][next[k]].square);
      else if (l[k] > 0.0)
        everywhere = false;
    }
    if (!everywhere) continue;
    const Fall fall = fallAt(l[0] * square[0] + l[1] * square[1] + l[2] * square[2] - within, a_);
    const double weight = load_[index(near.node)] * fall.value;
    total += weight;
    if (free_[index(near.node)] == 0 || !(weight > 0.0)) continue;
    sum += weight;
    patch.node[patch.count] = near.node;
    patch.weight[patch.count] = weight;
    Vec3& slope = patch.slope[patch.count++];
    if (!slopes) continue;
    slope = load_[index(near.node)] * fall.slope * (square - within_slope);
    sum_slope += slope;
  }
  if (!(sum > 0.0)) return;
  patch.free_share = sum / total;
  for (std::size_t i = 0; i < patch.count; ++i) {
    patch.weight[i] /= sum;
    if (slopes) patch.slope[i] = ((patch.slope[i] - patch.weight[i] * sum_slope) / sum).eval();
  }
}

}  // namespace palpate
