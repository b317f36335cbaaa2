// SPDX-License-Identifier: Apache-2.0
#include "tools/examine/reproduce/report_rod.h"

#include "tools/examine/reproduce/fill.h"

namespace palpate::reproduce {

namespace {

constexpr const char* kRodProblem = R"(## 1. The rod (Section 4.1, Figure 1)

A bar of length {length_mm:.0f} mm, cross section {area_mm2:.0f} mm2, E = {E_MPa:.1f} MPa, pulled by F = {force_N:.0f} N applied at any
point s of its axis: u(x, s) is two-dimensional. Mesh: {elements:.0f} linear elements, {elements:.0f} load positions (every free node).

**Exact solution.** In one dimension the material gives F = E A (l^3 - l) / 2 for the stretch l, so the part between the clamp and the load
is stretched by l and the rest moves along. The paper's Eq. (20) is this displacement without its unit: the right-hand side is the tip's
displacement *per length*, {formula_without_length:.10f}; the factor L is missing. With it, the tip moves by **{exact_tip_mm:.11f} mm** (K =
F/EA = {K:.2f}, l = {stretch:.10f}). Eq. (21) needs K >= 1/sqrt(27) = 0.19245; below that the square root is imaginary, and the stretch is
the real root of l^3 - l = 2 K.

| scheme | error at a step of 1e-3 in the paper | order here | error of the tip at the finest step here |
|---|---|---|---|
| ten terms, Eq. (19) | O(1e-4) | {order_ten_term:.3f} | {finest_ten_term:.3e} |
| forward Euler, Remark 2 | not given | {order_forward_euler:.3f} | {finest_forward_euler:.3e} |
| constant tangent K_T(0) | not in the paper | {order_constant_tangent:.3f} | {finest_constant_tangent:.3e} |

Order: least squares of log(error) over log(step) for steps of at most 1e-2.

)";

constexpr const char* kReading = R"(
**Reading Figure 1.** The paper reports an error of the order of 1e-4 at a step of 1e-3. That is what a scheme of first order gives here
({finest_forward_euler:.1e} for forward Euler, {finest_constant_tangent:.1e} with a constant tangent). The ten terms of Eq. (19), taken
literally, are one Newton step with the residual carried over: second order, {finest_ten_term:.1e}. So either the paper's runs dropped some
of the ten terms, or stopped enriching at that error, or its axis shows another error; the text leaves this open.

**Number of pairs.** The linear solution is min(x, s) F/EA, a function of full rank: every mesh has as many pairs as free nodes. Here
{pairs:.0f}. The number of pairs for the rod depends on the mesh and not on the method; the paper states neither.

**All load positions.** The largest error of u(x, s) over all x and s, at a step of 1e-3 with ten terms, relative to the exact tip
displacement: {finest_field_ten_term:.2e}.

**The displacement-driven series on the same rod** (what palpate's own solver does): prescribe the tip's displacement, expand force and
field in it. In one dimension the force is a cubic, so order 3 is exact, where the load-driven series has a radius of K = 0.19245 and
diverges at this load (K = {K:.2f}).

)";

}  // namespace

std::string rodChapter(const Json& results, const std::string& figures) {
  std::string text = fill(kRodProblem, results);
  for (const auto& [key, name] : {std::pair{"ten_term", "Ten terms"},
                                  {"forward_euler", "Forward Euler"},
                                  {"constant_tangent", "Constant tangent"}}) {
    text += std::string(name) + ":\n\n";
    text += table(results.at(key), {{"step", "dt", "{:.3g}"},
                                    {"error of the tip (relative)", "tip_error", "{:.4e}"},
                                    {"largest error of u(x, s)", "field_error", "{:.4e}"},
                                    {"pairs", "pairs", "{:.0f}"}}) +
            "\n";
  }
  text += "![Error of the tip over the step](" + figures + "figure-1-rod-convergence.svg)\n";
  text += fill(kReading, results);
  text += table(results.at("series_displacement"),
                {{"order", "order", "{:.0f}"}, {"error of the tip (relative)", "tip_error", "{:.2e}"}});
  return text;
}

}  // namespace palpate::reproduce
