// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/base/contact_point.h"
#include "core/base/types.h"
#include "core/surface/surface_distance.h"

namespace palpate {

/// The nodes of one contact patch and their weights w_i(s), sum 1: the first `count` of each. Its memory is made once, so
/// that a patch can be found in a tick.
struct PatchNodes {
  std::size_t count{0};
  std::vector<std::int32_t> node;  ///< surface nodes that carry load, ascending
  std::vector<double> weight;      ///< w_i
  std::vector<Vec3> slope;         ///< dw_i/dlambda, lambda the barycentric weights of s; where asked for
  double free_share{0.0};          ///< of the weights before clamped nodes were left out, in [0, 1]
};

/// Contact patches at any point of a surface.                                             docs/design.md, Symbols
///   w_i(s) ~ A_i exp(-r_i^2 / 2 a^2) t(r_i / 3 a),   t(x) a quintic from 1 at x = 0.6 to 0 at x = 1
/// for free nodes, sum 1. The distance r_i from s is that of a plane triangle's point from a point beyond it,
///   r_i(s)^2 = sum_b lambda_b r_ib^2 - sum_(b < c) lambda_b lambda_c |X_b - X_c|^2,
/// exact where the shortest way is straight, with r_ib the distance along the surface from corner b. So weights are
/// continuous over edges, smooth within triangles, and cost no walk over the surface. Const once built.
class ContactPatches {
 public:
  static constexpr std::size_t kMostNodes = 2048;             ///< near one node: 25 edges
  static constexpr std::size_t kMostTogether = 64ULL << 20U;  ///< near all nodes: half a GiB

  /// @param free  [Ns] 1: the node may carry load  @param a  m, > 0
  /// @param centres  corners whose faces may be asked for; O(k log k) each for k nodes within 3 a. Not real-time.
  /// @throw std::invalid_argument when a is so large that patches exceed the limits above
  ContactPatches(const SurfaceGraph& graph, std::span<const std::uint8_t> free, double a,
                 std::span<const std::int32_t> centres);
  ContactPatches(ContactPatches&&) = default;  // no copies: near_ borrows from lists_
  ContactPatches& operator=(ContactPatches&&) = default;

  /// The patch at s; empty where no free node is near, or a corner of s with lambda > 0 is not among the centres.
  /// @param[out] patch  made by room(). Cost O(k). Real-time: yes.
  void at(const ContactPoint& s, bool slopes, PatchNodes& patch) const noexcept PALPATE_NONBLOCKING;
  /// A patch with room for any result. Not real-time.
  [[nodiscard]] PatchNodes room() const;
  /// Sets near[i] to 1 for each node i that a patch in a triangle at the centre may load: free, and of an A_i above 0.
  /// @param near  [Ns]
  void markNear(std::int32_t centre, std::span<std::uint8_t> near) const;
  /// Nodes near the centres, of all together.
  [[nodiscard]] std::size_t entries() const noexcept { return entries_; }

 private:
  struct Near {
    std::int32_t node;
    float square;  // r_ib^2, m^2: half the memory of doubles, and weights that are off by 1e-7
  };
  void findNear(const SurfaceGraph& graph, std::span<const std::int32_t> centres);
  [[nodiscard]] std::span<const Near> nearTo(std::int32_t centre) const noexcept PALPATE_NONBLOCKING {
    return near_[static_cast<std::size_t>(centre)];
  }

  double a_;
  std::vector<std::int32_t> triangles_;       // [faces][3]
  std::vector<std::array<double, 3>> edges_;  // [faces] squared length of the edge opposite to corner k, m^2
  std::vector<double> load_;                  // [Ns] A_i, m^2
  std::vector<std::uint8_t> free_;            // [Ns]
  std::vector<std::vector<Near>> lists_;      // of all centres, in pieces of 1 MiB at most
  std::vector<std::span<const Near>> near_;   // [Ns] into lists_: of each centre by node
  std::size_t entries_{0}, most_{0};
};

}  // namespace palpate
