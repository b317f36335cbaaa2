// SPDX-License-Identifier: Apache-2.0
#include "tools/examine/reproduce/report_liver.h"

#include "tools/examine/reproduce/fill.h"

namespace palpate::reproduce {

namespace {

constexpr const char* kLiverProblem = R"(## 3. The liver (Section 4.3, Figures 5 to 7)

{mesh}: {nodes:.0f} nodes, {tetrahedra:.0f} tetrahedra, {surface_nodes:.0f} nodes on the boundary; E = {E_kPa:.0f} kPa, nu = {nu:.2f},
clamped at `fixed` ({fixed_nodes:.0f} nodes), the whole free boundary accessible ({positions_count:.0f} load positions), load downward.

**What the paper leaves open.** It names a mesh of 8559 nodes and 10,519 tetrahedra, 2009 nodes on the boundary. That is impossible: a body
of tetrahedra with n_i nodes inside and n_b on the boundary has at least 3 n_i + n_b - 3 of them, which is 21,656; 8559 may be the degrees
of freedom of some 2853 nodes. The size of the unit load is not stated; a single nodal force has no limit under refinement, so we load a
patch of width a = {patch_radius_mm:.2f} mm (weights exp(-r^2/2a^2) along the surface), {load_N:.3f} N, which moves the patch by
{travel_mm:g} mm in the median over a sample of positions, by linear theory.

![The mesh](@figure-5-liver-model.png)

### Linear: u(x, s) by PGD

Greedy enrichment with alternating directions and scalar Y, with updates of all Y for fixed X. The PGD forms no table of solutions for
single positions. Energy-norm error over all positions, relative; *raw* is the first n greedy pairs, *recompressed* is n pairs out of at
most 1.5 n greedy ones, *best* is the SVD in the energy norm, from {positions_count:.0f} full solutions for this comparison only.

)";

constexpr const char* kLinear = R"(
{linear_greedy_pairs:.0f} greedy pairs took {linear_seconds:.0f} s, residual {pct_linear_residual:.2f} % in the energy norm; the table of
all solutions for the comparison {linear_svd_seconds:.0f} s. The last two columns compare linear PGD with linear finite elements at
{samples:.0f} held-out points off the nodes: largest error of the surface field and error of the contact displacement, relative to the
contact displacement, 95 % quantile. The exact solutions at the nodes, interpolated like Y, have errors of
{pct_linear_interpolation_field_error_p95:.2f} % and {pct_linear_interpolation_contact_error_p95:.2f} %, which more pairs do not reduce.

![Six X functions](@figure-6-liver-x.png)

![Six Y functions](@figure-7-liver-y.png)

Like the paper's, they resemble those of a POD, and their frequency grows with k. Third component of X_k, first six pairs, each with its own
colour scale.

### Nonlinear: u(x, s, f), any direction

The series of order {order:.0f} in the force, by the same recursion as palpate's own with f prescribed, compressed to n pairs X_k(x) Y_k(s)
times powers of f. Against full Newton at {samples:.0f} held-out points off the nodes, random directions, loads evenly up to the load that
moves the contact by {travel_mm:g} mm in linear theory, {loads_limited:.0f} of them reduced to the domain of the series (contact moved by
{loads_median_mm:.2f} mm in the median, {loads_largest_mm:.2f} mm at most). *Field*: largest error on the surface; *contact*: error of the
contact displacement; *force*: error of the force when the true contact displacement is imposed. All relative, 95 % quantiles unless said
otherwise. *SVD*: the best separation of the same series in the mean square over surface, positions and loads; its largest error on the
surface need not be the smallest. The points lie between the nodes, so all columns include the interpolation error (above), those of the
three-part model too.

)";

constexpr const char* kThreePart = R"(
| palpate's three-part model ({three_part_modes:.0f} modes, near field, contact response) at the same points | |
|---|---|
| field, 95 % | {pct_three_part_field_error_p95:.2f} % |
| contact, 95 % | {pct_three_part_contact_error_p95:.3f} % |
| force, 95 % | {pct_three_part_force_error_p95:.3f} % |
| file | {three_part_MiB:.1f} MiB, of the (s, f) model with {evaluation_pairs:.0f} pairs {model_MiB:.1f} MiB |

![Error over the number of pairs](@figure-liver-errors.svg)

**Reading it.** The paper states good agreement of 167 pairs with full Newton, without a number. A separated representation converges slowly
near the tool, because each position has a dimple of its own; the three-part model therefore has a near field and a contact response of its
own, which are exact at the nodes. Between nodes it is as good as its interpolation. On a coarse mesh these rows compare interpolations, and
a load-driven model, which interpolates compliance, can be better.

)";

constexpr const char* kTenTerms = R"(### The ten-term scheme on a liver-like organ

A liver at {ten_term_element_size_mm:g} mm elements, to keep the run short: {ten_term_nodes:.0f} nodes, {ten_term_tetrahedra:.0f}
tetrahedra, {ten_term_positions:.0f} load positions, {ten_term_load_N:.2f} N downward in {ten_term_steps:.0f} load steps; residual of a step
at most {pct_ten_term_residual:.1f} % (tolerance: {pct_ten_term_tolerance:.1f} %). {ten_term_pairs:.0f} pairs in {ten_term_seconds:.0f} s.
Against full Newton at {ten_term_samples:.0f} positions: field {pct_ten_term_field_error_p95:.2f} % (95 %), contact
{pct_ten_term_contact_error_p95:.3f} %; the error of the linear solution is {pct_ten_term_linear_field_error_p95:.1f} % there.

)";

constexpr const char* kOnline = R"(### Online

The whole surface ({surface_nodes:.0f} nodes) from {evaluation_pairs:.0f} pairs: {evaluation_us:.0f} us, **{evaluations_per_second:.0f}
evaluations a second** on one core, with the server's code. The paper: 25 Hz on a tablet, the order of 1 kHz on a laptop (Core i7, 2.66
GHz).

)";

}  // namespace

std::string liverChapter(const Json& results, const std::string& figures) {
  std::string text = withFolder(fill(kLiverProblem, results), figures);
  text +=
      table(results.at("linear").at("pairs_table"), {{"n", "pairs", "{:.0f}"},
                                                     {"best (SVD), %", "svd_energy_error", "{:.3f}", 100.0},
                                                     {"recompressed, %", "energy_error", "{:.3f}", 100.0},
                                                     {"/ best", "ratio", "{:.3f}"},
                                                     {"greedy pairs used", "greedy_pairs", "{:.0f}"},
                                                     {"raw greedy, %", "raw_energy_error", "{:.3f}", 100.0},
                                                     {"/ best", "raw_ratio", "{:.3f}"},
                                                     {"field, %", "field_error_p95", "{:.2f}", 100.0},
                                                     {"contact, %", "contact_error_p95", "{:.2f}", 100.0}});
  text += withFolder(fill(kLinear, results), figures);
  text += table(results.at("modes_table"), {{"pairs", "pairs", "{:.0f}"},
                                            {"field, %", "field_error_p95", "{:.2f}", 100.0},
                                            {"field, SVD, %", "svd_field_error_p95", "{:.2f}", 100.0},
                                            {"contact, %", "contact_error_p95", "{:.2f}", 100.0},
                                            {"contact, largest, %", "contact_error_max", "{:.2f}", 100.0},
                                            {"force, %", "force_error_p95", "{:.2f}", 100.0}});
  text += withFolder(fill(kThreePart, results), figures);
  if (results.contains("ten_term")) text += fill(kTenTerms, results);
  return text + fill(kOnline, results);
}

}  // namespace palpate::reproduce
