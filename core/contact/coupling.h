// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/base/budget.h"
#include "core/base/types.h"
#include "core/response/patch_response.h"
#include "core/response/response.h"

namespace palpate {

/// What a tool does to the patch that it holds, and how the two are joined. As one tick has them.
struct ContactLaw {
  double friction{0.0};         ///< mu; infinity: the anchor never slides
  double compliance{0.0};       ///< 1 / K_vc of the virtual coupling, m/N; 0: the tool holds the patch itself
  double stiffness_scale{1.0};  ///< E over the model's own: the factor on the model's forces
  double period{1e-3};          ///< of a tick, s
};

/// e, the part of a patch's displacement that other tools cause, as it changes with the patch's own: a tool pushes the
/// others' patches, whose tools push back (tool_coupling.h); and with the patch's place, while the others stay.
struct Carried {
  Vec3 constant = Vec3::Zero();  ///< m
  Mat3 slope = Mat3::Zero();     ///< de/dd, 1
  Mat3 along = Mat3::Zero();     ///< de/dX over the rest surface, 1
  Vec3 origin = Vec3::Zero();    ///< the X that `constant` is for, m
  [[nodiscard]] Vec3 at(const Vec3& d) const noexcept PALPATE_NONBLOCKING { return constant + slope * d; }
  /// The same for a patch at X.
  [[nodiscard]] Carried movedTo(const Vec3& X) const noexcept PALPATE_NONBLOCKING {
    return {constant + along * (X - origin), slope, along, X};
  }
};

/// A patch and a tool in balance.
struct CoupledResponse {
  Vec3 displacement = Vec3::Zero();  ///< d that the tool imposes through the coupling, m
  Response response;  ///< the organ's answer, with E and the other tools: force f in N, stiffness df/dd
  Mat3 stiffness = Mat3::Zero();  ///< df/dg, N/m: organ and coupling in series
};

/// The virtual coupling: tool - spring - patch, the organ as it answers               docs/design.md, Contact
///   f(s, d) - df/dd e(d) = K_vc (g - d),   g where the tool would have the patch if the spring were rigid
/// Its derivative is taken as df/dd (1 - de/dd).
/// Newton on d, from `out.displacement`, halved where it does not help; at most 8 steps of up to 5 evaluations, 1 or 2
/// when g moves little. Numbers that overflow come out as respond() gives them. Cut short by the budget: the d with the
/// least residual so far and the organ's answer to it; where there is none, `out` stays as it was.
/// @param[in] g  W, m, finite, @param[in] carried  e(d), finite, @param[in,out] out  displacement: where to begin. Real-time: yes.
ResponseStatus couple(const PatchResponse& patch, const Vec3& g, const Carried& carried,
                      const ContactLaw& law, Budget& budget,
                      CoupledResponse& out) noexcept PALPATE_NONBLOCKING;

}  // namespace palpate
