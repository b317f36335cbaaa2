// SPDX-License-Identifier: Apache-2.0
#include "tools/examine/reproduce/report_beam.h"

#include "tools/examine/reproduce/fill.h"

namespace palpate::reproduce {

namespace {

constexpr const char* kBeamProblem = R"(## 2. The beam (Section 4.2, Figures 2 to 4)

A beam of 400 x 40 x 40 mm, clamped at one end, {nodes:.0f} nodes ({nodes_along:s}), {tetrahedra:.0f} tetrahedra, E = {E_MPa:.1f} MPa, nu =
{nu:.2f}; a vertical load at any node of the upper surface ({positions_count:.0f} free ones).

**The load is not stated in the paper.** We take a single nodal force of {load_N:g} N downward, which moves the tip by {tip_newton_mm:.3f}
mm (full Newton), {pct_tip_newton_share:.1f} % of the length. Six tetrahedra a cell, along the diagonal from the cell's smallest to its
largest corner.

![The mesh](@figure-2-beam-model.png)

| tip displacement, load at the tip | mm | against Newton |
|---|---|---|
| full Newton (reference of the paper and ours) | {tip_newton_mm:.4f} | |
| ten terms, {steps:.0f} load steps, separated | {tip_ten_term_mm:.4f} | {pct_tip_ten_term_error:+.3f} % |
| ten terms, {steps:.0f} load steps, this load alone, not separated | {tip_ten_term_alone_mm:.4f} | {pct_tip_ten_term_alone_error:+.4f} % |
| linear | {tip_linear_mm:.4f} | {pct_tip_linear_error:+.2f} % |
| forward Euler, {steps:.0f} load steps, separated | {tip_forward_euler_mm:.4f} | {pct_tip_forward_euler_error:+.2f} % |
| forward Euler, {steps:.0f} load steps, this load alone, not separated | {tip_forward_euler_alone_mm:.4f} | {pct_tip_forward_euler_alone_error:+.2f} % |

Enrichment stops at a residual of {pct_tolerance:.1f} % (energy norm, worst position) in each load step: the difference between the rows of
one scheme.

**One separated solution for all positions**: {pairs:.0f} pairs X_k(x) Y_k(s, t), of which {pairs_linear:.0f} were born in the first load
step; the level dependence takes {level_functions:.0f} functions Z(t). Solved in {seconds_ten_term:.0f} s. Relative L2 error of the whole
field against full Newton, each of the {positions_count:.0f} positions by itself: largest {pct_l2_error_max:.3f} %, 95 % of them below
{pct_l2_error_p95:.3f} %, median {pct_l2_error_median:.3f} %. The paper states neither the number of pairs nor an error.

![Error at every position](@figure-beam-positions.svg)

![Displacement of the tip over the load](@figure-beam-load.svg)

Errors are weighted by 1/|u(s)|. In the plain integral over s, positions near the clamp would have no weight, since displacements there are
small (the tip moves by {least_tip_mm:.3f} mm when the load stands nearest to the clamp). A step adds pairs only when the old X with new Y
do not suffice.

)";

constexpr const char* kVolume = R"(
**Volume.** The paper states that the ten terms give no unphysical gain of volume. Change of the beam's volume with the load at the tip:

| solution | change of volume |
|---|---|
| linear | {pct_volume_change_linear:+.3f} % |
| ten terms, separated | {pct_volume_change_ten_term:+.4f} % |
| forward Euler, separated | {pct_volume_change_forward_euler:+.4f} % |
| full Newton | {pct_volume_change_newton:+.4f} % |

The ten terms change the volume by {volume_ratio:.4f} of the linear solution's change{volume_verdict}.

![Deformed beam, ten terms](@figure-3-beam-deformed.png)

**Forward Euler (Figure 4).** The paper shows a beam bent much too far and puts it down to the material's instability under compression.
Here forward Euler (K_T(u) D = dF, without the residual) ends {tip_forward_euler_word} by {pct_tip_forward_euler_size:.1f} % at the tip. The
smallest det F of that solution is {min_det_f_forward_euler:.2f}, with Newton {min_det_f_newton:.2f}. )";

constexpr const char* kShort =
    R"(No element is close to inversion. The error has another cause: each step moves the nodes along straight lines. That stretches a beam that
turns, and no later step corrects the stretch: its axis ends {pct_axis_stretch_forward_euler:+.3f} % longer, with ten terms
{pct_axis_stretch_ten_term:+.3f} %, with Newton {pct_axis_stretch_newton:+.3f} %. With E A = {axial_stiffness_N:.0f} N that is a tension of
{forward_euler_tension_N:.2f} N along a beam that carries {load_N:g} N across: it stiffens the beam like a cable. At this load and step the
scheme of the text does not give Figure 4 of the paper.
)";

constexpr const char* kPicture = R"(
![Forward Euler beside Newton](@figure-4-beam-forward-euler.png)

)";

}  // namespace

std::string beamChapter(const Json& results, const std::string& figures) {
  std::string text = withFolder(fill(kBeamProblem, results), figures);
  text +=
      table(results.at("load_curve"), {{"level t", "level", "{:.2f}"},
                                       {"Newton, mm", "newton_mm", "{:.4f}"},
                                       {"ten terms, mm", "ten_term_mm", "{:.4f}"},
                                       {"forward Euler, mm", "forward_euler_mm", "{:.4f}"},
                                       {"linear, mm", "linear_mm", "{:.4f}"},
                                       {"L2 error of ten terms, %", "ten_term_l2_error", "{:.4f}", 100.0}});
  text += withFolder(fill(kVolume, results), figures);
  const bool short_and_sound = results.at("tip").at("forward_euler_error").get<double>() < 0.0 &&
                               results.at("min_det_f").at("forward_euler").get<double>() > 0.5;
  text += short_and_sound ? fill(kShort, results) : std::string("\n");
  return text + withFolder(kPicture, figures);
}

}  // namespace palpate::reproduce
