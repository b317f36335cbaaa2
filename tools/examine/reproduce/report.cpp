// SPDX-License-Identifier: Apache-2.0
#include "tools/examine/reproduce/report.h"

#include "tools/examine/reproduce/fill.h"
#include "tools/examine/reproduce/report_beam.h"
#include "tools/examine/reproduce/report_liver.h"
#include "tools/examine/reproduce/report_rod.h"

namespace palpate::reproduce {

namespace {

constexpr const char* kHead = R"(# The paper's benchmarks, reproduced

S. Niroomandi, D. Gonzalez, I. Alfaro, F. Bordeu, A. Leygue, E. Cueto, F. Chinesta, "Real-time simulation of biological soft tissues: a PGD
approach", Int. J. Numer. Meth. Biomed. Engng 29 (2013) 586-600, doi 10.1002/cnm.2544, called "the paper" below.

Written by `palpate-reproduce` {version} on {date}, on {machine}. That run computed every figure below; results.json beside this file holds
them too. Times are of that machine.
)";

constexpr const char* kQuick = R"(
**A quick run** (`--quick`): the studies are those of a full run, the meshes are coarser, the load steps and held-out points fewer. The
errors below belong to these smaller cases.
)";

constexpr const char* kSettled = R"(
## Where the paper is wrong or silent, and how it is settled here

| place | what it says | what is done here |
|---|---|---|
| Eq. (14) | E = sym grad u + (grad u . grad u^T)/2 with F = grad u + I | with F = I + H, H_ij = du_i/dX_j, the quadratic term is H^T H / 2; the paper's formula holds when its gradient is the transpose |
| Eqs. (18), (19) | integrals over Omega(t) | over the reference domain: S, E and the gradients are those of the reference configuration (total Lagrangian) |
| Eq. (19) | ten terms | read as the text describes them, the constant and linear terms of Eq. (18): f_int(u) + K_T(u) D, one Newton iteration a load step |
| Eq. (20) | a displacement without unit | times the length L |
| Eq. (21) | K^2 - 1/27 under a root | for K below 1/sqrt(27) the real root of the cubic |
| Figure 1 | error of order 1e-4 at a step of 1e-3 | three schemes side by side, with their orders |
| 4.2 | no size of the load, no number of pairs | both are stated |
| Figure 4 | forward Euler bends far too much | shown as computed |
| 4.3 | 8559 nodes with 10,519 tetrahedra | impossible for tetrahedra; sizes are stated |
| 4.3 | a unit load at a point | a patch of stated width; the size of the load is stated |
| 4.3 | 167 pairs agree well | errors over the number of pairs |

)";

}  // namespace

std::string report(const Json& results, bool nested) {
  std::string text = fill(kHead, results.at("run"));
  const Json* const quick = results.at("run").find("quick");
  if (quick != nullptr && quick->get<bool>()) text += kQuick;
  text += kSettled;
  const auto folder = [&](const char* name) { return nested ? std::string(name) + "/" : std::string(); };
  if (results.contains("rod")) text += rodChapter(results["rod"], folder("rod")) + "\n";
  if (results.contains("beam")) text += beamChapter(results["beam"], folder("beam")) + "\n";
  if (results.contains("liver")) text += liverChapter(results["liver"], folder("liver"));
  return text;
}

}  // namespace palpate::reproduce
