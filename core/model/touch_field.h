// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/base/contact_point.h"
#include "core/base/max_tools.h"
#include "core/base/multi_index.h"
#include "core/base/types.h"
#include "core/model/meta_model.h"
#include "core/model/smooth_mixing.h"
#include "core/model/touch_patch.h"

namespace palpate {

/// Values of the functions that a touch's field is a sum of: of u, and of du/dd_x, du/dd_y, du/dd_z.
using TouchFunctions = std::array<std::array<double, MonomialBasis::kMaxCoefficients>, kTogether>;

/// What a touch moves a patch by, u averaged, and how that changes with d and as the patch slides.
struct PatchMotion {
  /// u, du/dd_x, du/dd_y, du/dd_z by the weights of the patch, and by their derivatives by lambda.
  std::array<NodeSum::Vectors, TouchPatch::kWeights> by;

  /// u + du/dd y, m.
  [[nodiscard]] Vec3 at(const Vec3& y) const noexcept PALPATE_NONBLOCKING { return at(by[0], y); }
  /// du/dd, 1.
  [[nodiscard]] Mat3 slope() const noexcept PALPATE_NONBLOCKING { return by[0].rightCols<3>(); }
  /// The derivative of at(y) by lambda, m.
  [[nodiscard]] Mat3 along(const Vec3& y) const noexcept PALPATE_NONBLOCKING {
    Mat3 out;
    for (Eigen::Index k = 0; k < 3; ++k) out.col(k) = at(by[static_cast<std::size_t>(k) + 1], y);
    return out;
  }

 private:
  static Vec3 at(const NodeSum::Vectors& u, const Vec3& y) noexcept PALPATE_NONBLOCKING {
    return u.col(0) + u.rightCols<3>() * y;
  }
};

/// The field of one touch, for others to be asked about: u and du/dd, found once for a place and a d.  docs/design.md, Parts
/// Its memory is made once, so that a tick can fill it.
class TouchField {
 public:
  explicit TouchField(const MetaModel& model);

  /// The touch at from.s() that imposes d. @param from  its patch; by it the linear part is superposed  @param step  of the
  /// differences that `functions` has, m  @param functions  at d. Cost O(C n), of another s O(stencil C n). Real-time: yes.
  void set(const MetaModel& model, const TouchPatch& from, const Vec3& d, double step,
           const TouchFunctions& functions) noexcept PALPATE_NONBLOCKING;
  /// Whether that was set last.
  [[nodiscard]] bool is(const ContactPoint& s, const Vec3& d, double step) const noexcept {
    return s_ == s && d_ == d && step_ == step;
  }

  /// What it moves another patch by. @param from  as in set(). Cost O(n + k), once for all that are near O(stencil C K).
  /// Real-time: yes.
  [[nodiscard]] PatchMotion on(const MetaModel& model, TouchPatch& from,
                               const TouchPatch& to) noexcept PALPATE_NONBLOCKING;
  /// u + du/dd y at a point of the drawn surface, m. @param scratch  [n]. Cost O(n). Real-time: yes.
  [[nodiscard]] Vec3 at(const MetaModel& model, TouchPatch& from, const Vec3& y, const ContactPoint& point,
                        std::span<float> scratch) noexcept PALPATE_NONBLOCKING;

 private:
  void findNear(const MetaModel& model) noexcept PALPATE_NONBLOCKING;

  ContactPoint s_;
  Vec3 d_ = Vec3::Zero();
  double step_{0.0};
  Stencil stencil_;
  std::size_t modes_, functions_, rows_;  // n, C, Cm
  std::vector<std::int32_t> row_;         // [Cm] their numbers
  std::vector<float> Y_;                  // [Cm][n] mixed at s
  std::vector<float> phi_;                // [Cm][kTogether]
  std::array<Vec3, kTogether> load_;      // N, on the patch of a "displacement" model
  std::vector<float> y_;                  // [kTogether][n]
  NodeSum near_;                          // of positions and edges
  bool near_found_{false};
  std::int32_t reached_{-1};  // the triangle whose near fields near_ reaches
  double reach_{0.0};         // of near_, from X(s), m
  std::vector<float> block_;  // of one source, kTogether vectors for each node, and a number behind
};

/// A touch that others are asked about: its patch, and its field where that is asked for.
struct Touch {
  explicit Touch(const MetaModel& model) : patch(model), field(model) {}
  TouchPatch patch;
  TouchField field;
};

/// Touches of tools, as they were asked about last: one that sticks finds its own again. One thread's, allocated before the loop.
struct Touches {
  explicit Touches(const MetaModel& model);
  std::array<Touch, kMaxTools> all;
  std::vector<float> amplitudes;  ///< [n] scratch
};

}  // namespace palpate
