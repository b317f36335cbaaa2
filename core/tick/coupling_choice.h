// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

#include "core/base/types.h"

namespace palpate {

/// An organ as its coupling sees it.
struct OrganStiffness {
  double youngs_modulus;  ///< E that the model was solved with, Pa
  double largest;         ///< K_max at this E, N/m; infinity: not known, as of a rigid organ
};

/// 1 / K_vc, m/N: the coupling that is asked for, or the softer one that keeps organ and coupling in series below what is
/// to be rendered:
///   1 / K_vc = max(1 / K_asked, 1 / K_rendered - 1 / K_max(E))                           docs/design.md, Contact
/// 0: none. It goes with E continuously, from none at K_max = K_rendered to K_rendered at a rigid organ.
/// @param asked, rendered  1 / K_asked and 1 / K_rendered, m/N; 0: infinity. @param E  in force, Pa. Real-time: yes.
[[nodiscard]] inline double couplingCompliance(double asked, double rendered, const OrganStiffness& organ,
                                               double E) noexcept PALPATE_NONBLOCKING {
  return std::max(asked, rendered - organ.youngs_modulus / (organ.largest * E));
}

}  // namespace palpate
