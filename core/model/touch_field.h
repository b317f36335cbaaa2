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

/// The field of one touch, for others to be asked about: u and du/dd.                               docs/design.md, Parts
/// What modes and near fields of positions and edges give, orders of two and more of a "displacement" model, is found at a d_0
/// near d and goes on from there along its slopes. It is kept by position while the touch stays in its triangle and d near d_0,
/// so that a touch that slides only mixes. Its memory is made once, so that a tick can fill it.
class TouchField {
 public:
  /// What the positions' parts depend on.
  struct Origin {
    std::int32_t triangle{-1};  ///< of s
    std::size_t positions{0};   ///< that answer there
    Vec3 d = Vec3::Zero();      ///< d_0, m
    double limit{0.0};          ///< of the functions, where d_0 is beyond it, else 0
    double step{0.0};           ///< of differences, m
    [[nodiscard]] bool operator==(const Origin&) const noexcept = default;
  };

  /// @param room  roomFor()
  TouchField(const MetaModel& model, std::size_t room);
  /// Numbers that near fields in any triangle take, up to a bound: what is beyond it is found again each time.
  [[nodiscard]] static std::size_t roomFor(const MetaModel& model);

  [[nodiscard]] const Origin& origin() const noexcept { return origin_; }
  [[nodiscard]] const ContactPoint& s() const noexcept { return s_; }
  [[nodiscard]] const Vec3& d() const noexcept { return d_; }
  /// @param functions  at origin.d. Cost O(stencil C n). Real-time: yes.
  void moveOrigin(const MetaModel& model, const Origin& origin,
                  const TouchFunctions& functions) noexcept PALPATE_NONBLOCKING;
  /// The touch at from.s() that imposes d, of this origin. @param from  its patch; by it the linear part is superposed
  /// Cost O(stencil n). Real-time: yes.
  void set(const MetaModel& model, const TouchPatch& from, const Vec3& d) noexcept PALPATE_NONBLOCKING;

  /// What it moves another patch by. @param from  as in set(). Cost O(n + k); once for all that are near O(stencil K), and
  /// O(stencil C K) of a new origin. Real-time: yes.
  [[nodiscard]] PatchMotion on(const MetaModel& model, TouchPatch& from,
                               const TouchPatch& to) noexcept PALPATE_NONBLOCKING;
  /// u + du/dd y at a point of the drawn surface, m. @param scratch  [n]. Cost O(n). Real-time: yes.
  [[nodiscard]] Vec3 at(const MetaModel& model, TouchPatch& from, const Vec3& y, const ContactPoint& point,
                        std::span<float> scratch) noexcept PALPATE_NONBLOCKING;

 private:
  void findNear(const MetaModel& model) noexcept PALPATE_NONBLOCKING;

  Origin origin_;
  ContactPoint s_;
  Vec3 d_ = Vec3::Zero();
  Stencil stencil_;
  std::size_t modes_;
  std::vector<float> phi_;     // [Cm][kTogether]
  std::vector<float> kept_y_;  // [stencil][kTogether][n] of the positions
  std::vector<float> kept_;    // blocks of near fields, one after the other, as far as there is room
  std::size_t room_;           // of kept_; behind it there is room for a block that is not kept
  bool near_kept_{false};
  std::array<Vec3, kTogether> load_;  // N, on the patch of a "displacement" model
  std::vector<float> y_;              // [kTogether][n]
  NodeSum near_;                      // of positions and edges
  bool near_found_{false};
  double reach_{0.0};  // of near_, from X(s), m
};

/// A touch that others are asked about: its patch, and its field where that is asked for.
struct Touch {
  Touch(const MetaModel& model, std::size_t room) : patch(model), field(model, room) {}
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
