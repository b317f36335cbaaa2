// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>

#include "core/base/contact_point.h"
#include "core/base/max_tools.h"
#include "core/base/types.h"
#include "core/model/field_evaluation.h"
#include "core/model/meta_model.h"
#include "core/model/touch_field.h"
#include "core/response/patch_response.h"

namespace palpate {

/// What a tool that imposes d by itself adds to the field: of evaluateField(). Beyond
/// Response::shown_radius its gain is |d| over the |d| that the model answers, so that the field goes on in proportion (not of a
/// model driven by level, which ends where its load does). @param d  m, finite. Cost respond(). Real-time: yes.
[[nodiscard]] FieldSource ownPart(const MetaModel& model, const ContactPoint& s,
                                  const Vec3& d) noexcept PALPATE_NONBLOCKING;

/// How long the differences are that derivatives by d of a load-driven model are taken by, m. @param d  of all tools, m
[[nodiscard]] double tangentStep(std::span<const Vec3> d) noexcept PALPATE_NONBLOCKING;

/// Makes `touch` that of a tool that imposes d at s by itself. @param step  tangentStep(), unused for a "displacement" model
/// Cost O(k n) for another s, O(C n) for another d. Real-time: yes.
void touchWith(const MetaModel& model, const ContactPoint& s, const Vec3& d, double step,
               Touch& touch) noexcept PALPATE_NONBLOCKING;

/// What a touch moves the contact patch of another by: P_to u, far plus near field, and its derivatives by d and by the place of
/// that patch. Zero where the model has no answer at one of the two.                          docs/design.md, Symbols, Parts
/// @param from  touchWith()  @param to  its patch. Cost docs/decisions/several_tools.md. Real-time: yes.
[[nodiscard]] inline PatchMotion patchMotion(const MetaModel& model, Touch& from,
                                             const Touch& to) noexcept PALPATE_NONBLOCKING {
  return from.field.on(model, from.patch, to.patch);
}

/// How e_A = d_A - d_own,A, the displacement of each patch that the others cause, changes, the tangents held fixed.
struct Influence {
  std::array<std::array<Mat3, kMaxTools>, kMaxTools> by_d;  ///< [A][B] de_A/dd_B, 1
  /// [A] de_A/dX as the patch moves over the rest surface and the others' own parts stay, 1; zero along its triangle's normal
  std::array<Mat3, kMaxTools> along;
};

/// Tools that press together: what each imposes by itself, so that all patches move as prescribed.  docs/design.md, Contact
///   d_own,A + sum_{B != A} P_A [u(s_B, d_B) + u'(s_B, d_B) (d_own,B - d_B)] = d_A
/// Linear in d_own: the tangent at what each patch really does, so that the tools' own parts, which may be several
/// times d and cancel each other, need no nonlinear answer far from it. With y_A = d_own,A - d_A
///   f_A = f(s_A, d_A) + df/dd(s_A, d_A) y_A,   u = sum_A ownField()
/// Exact for a linear organ; the error of a nonlinear one is what palpate-query --tool2 measures. The least-squares
/// answer at a small price for its length: tools at one place that ask for different d would need any force.
/// @param s  contact points, at most kMaxTools, all in contact  @param d  prescribed, m, finite, one for each
/// @param[out] own  d_own, m; d itself for one tool
/// @param[out] touches  those of the tools, in their order, where there are two or more  @param[out] influence  if given; zero for one tool
/// Cost tools * (tools - 1) patchMotion(), no iteration: docs/decisions/several_tools.md. Real-time: yes.
void ownDisplacements(const MetaModel& model, std::span<const ContactPoint> s, std::span<const Vec3> d,
                      Touches& touches, std::span<Vec3> own,
                      Influence* influence = nullptr) noexcept PALPATE_NONBLOCKING;

/// One tool's part in the field of several, u(s, d) + u'(s, d) (own - d), as two sources of evaluateField() whose
/// sum it is: a difference over a step much shorter than the domain. Real-time: yes.
[[nodiscard]] std::array<FieldSource, 2> ownField(const MetaModel& model, const ContactPoint& s,
                                                  const Vec3& d,
                                                  const Vec3& own) noexcept PALPATE_NONBLOCKING;

/// The same, and the gain that its force has.
struct ToolPart {
  ContactPoint s;
  Vec3 d, own;  ///< m
  double gain{1.0};
};

/// What tools add to fieldAt() at points that are not their own, of a "displacement" model. @param points  triangle -1: nothing
/// @param[out] touches  those of the tools, in their order  @param[in,out] u  [points] m. Real-time: yes.
void addOthersAt(const MetaModel& model, std::span<const ToolPart> tools, Touches& touches,
                 std::span<const ContactPoint> points, std::span<Vec3> u) noexcept PALPATE_NONBLOCKING;

}  // namespace palpate
