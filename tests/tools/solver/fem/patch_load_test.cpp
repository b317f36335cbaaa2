// SPDX-License-Identifier: Apache-2.0
// The program's contact patch on a large block against the half-space: the table in docs/design.md, Elements. Lengths in units
// of the patch's width a, moduli in units of E.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "../half_space.h"
#include "../supported_body.h"
#include "tools/mesh/quadratic.h"
#include "tools/solver/build/fine_part.h"

namespace palpate::solver {
namespace {

using std::numbers::pi;

/// The weight of a patch at the distance r from its middle.                            docs/design.md, Symbols
double weightAt(double r) {
  const double x = r / 3.0, z = std::max((x - 0.6) / 0.4, 0.0);
  return x < 1.0 ? std::exp(-0.5 * r * r) * (1.0 - z * z * z * (10.0 - 15.0 * z + 6.0 * z * z)) : 0.0;
}

double gaussian(double r) {
  return std::exp(-0.5 * r * r);
}

/// Mean depth under a pressure p(r), 0 beyond `reach`, of 1 N, weighted with the pressure:
///   int int p(x) p(y) (1 - nu^2) / (pi E |x - y|) dx dy,
/// the displacement of the surface by Boussinesq's point load (Johnson, Section 3.2). Polar coordinates round x take away
/// the 1 / |x - y|. By the midpoint rule.
double compliance(double (*p)(double), double reach, double nu) {
  constexpr int kSteps = 60, kAngles = 48;
  const double step = reach / kSteps;
  double force = 0.0, sum = 0.0;
  for (int i = 0; i < kSteps; ++i) {
    const double x = (i + 0.5) * step, share = 2.0 * pi * x * p(x) * step;
    double depth = 0.0;
    for (int j = 0; j < 2 * kSteps; ++j)
      for (int k = 0; k < kAngles; ++k) {
        const double s = (j + 0.5) * step, c = std::cos(2.0 * pi * (k + 0.5) / kAngles);
        depth += p(std::sqrt(x * x + s * s + 2.0 * x * s * c)) * step * 2.0 * pi / kAngles;
      }
    force += share;
    sum += share * depth;
  }
  return (1.0 - nu * nu) / pi * sum / (force * force);
}

// By Parseval's theorem of the Hankel transform: int exp(-k^2 a^2) dk = sqrt(pi) / 2 a.
TEST(HalfSpace, UnderAGaussianGivesWayAsInTheClosedForm) {
  EXPECT_NEAR(compliance(gaussian, 7.0, 0.3), 0.91 / (2.0 * std::sqrt(pi)), 1e-4);
}

/// The patch in the middle of the upper side of a block, which is even within the patch's reach.
class PatchOnABlock {
 public:
  /// @param size  of elements, edge to edge  @param half  of the block's sides, also its depth
  PatchOnABlock(int order, double size, double nu, double half)
      : nu_(nu), mesh_(meshOf(order, size, half)), body_(mesh_, {{1.0, nu}}, given()) {
    const PatchSurface surface = surfaceOf(body_.model(), mesh_);
    const auto middle = std::find_if(surface.positions.begin(), surface.positions.end(),
                                     [](const Vec3& X) { return X.norm() < 1e-9; });
    patch_ = makePatch(body_.model(), surface,
                       surface.atNode(static_cast<int>(middle - surface.positions.begin())), 1.0);
  }
  /// 1 / C_nn over that of the half-space: of the block that is held at the cut, and of one that follows the half-space.
  [[nodiscard]] double heldOverExact() const { return overExact(body_.zero()); }
  [[nodiscard]] double overExact() const {
    std::vector<PointLoad> loads;
    for (std::size_t i = 0; i < patch_.nodes.size(); ++i)
      loads.push_back({mesh_.nodes[static_cast<std::size_t>(patch_.nodes[i])], patch_.weights[i]});
    return overExact(
        halfSpaceAt(mesh_.groups.at("cut"), mesh_.nodes, loads, body_.model().material().elasticity));
  }

 private:
  static mesh::TetMesh meshOf(int order, double size, double half) {
    const std::vector<double> down = growingSteps(size, 2.5, 1.6, half);
    std::vector<double> across(down.rbegin(), down.rend() - 1);
    for (double& x : across) x = -x;
    across.insert(across.end(), down.begin(), down.end());
    mesh::TetMesh mesh = blockOf(across, across, down);
    for (std::size_t i = 0; i < mesh.nodes.size(); ++i)
      if (const Vec3& X = mesh.nodes[i]; X.cwiseAbs().maxCoeff() == half)
        mesh.groups["cut"].push_back(static_cast<std::int32_t>(i));
    return order == 2 ? mesh::quadraticOf(mesh) : mesh;
  }
  [[nodiscard]] std::vector<bool> given() const {
    std::vector<bool> given(3 * mesh_.nodes.size(), false);
    for (const std::int32_t node : mesh_.groups.at("cut")) std::fill_n(given.begin() + 3 * node, 3, true);
    return given;
  }
  [[nodiscard]] double overExact(const Eigen::VectorXd& cut) const {
    Eigen::VectorXd load = body_.zero();
    patch_.addForce(Vec3::UnitZ(), load);
    return compliance(weightAt, 3.0, nu_) / patch_.average(body_.solve(cut, load)).z();
  }

  double nu_;
  mesh::TetMesh mesh_;
  SupportedBody body_;
  Patch patch_;
};

/// A column of the table: by how much elements are too stiff at nu = 0.3, 0.48 and 0.495, %.
void expectTooStiff(int order, double size, const std::array<double, 3>& percent) {
  constexpr std::array kNu{0.3, 0.48, 0.495};
  for (std::size_t i = 0; i < kNu.size(); ++i)
    EXPECT_NEAR(100.0 * (PatchOnABlock(order, size, kNu[i], 6.0).overExact() - 1.0), percent[i],
                0.1 + 0.01 * percent[i])
        << "nu = " << kNu[i];
}

TEST(APatch, OnLinearElementsOf1p25WidthsIsTooStiff) {
  expectTooStiff(1, 1.0 / 0.8, {8.6, 24.8, 52.0});
}
TEST(APatch, OnLinearElementsAsByDefaultIsTooStiff) {
  expectTooStiff(1, 1.0 / 1.3, {5.1, 15.6, 33.3});
}
TEST(APatch, OnLinearElementsOfHalfTheDefaultIsLessTooStiff) {
  expectTooStiff(1, 0.5 / 1.3, {2.6, 8.8, 19.6});
}
TEST(APatch, OnQuadraticElementsAsByDefaultIsNearlyRight) {
  expectTooStiff(2, 1.0 / 0.8, {2.0, 3.7, 5.0});
}
TEST(APatch, OnFinerQuadraticElementsIsRight) {
  expectTooStiff(2, 1.0 / 1.3, {0.4, 1.0, 1.5});
}

// A block that is held at a distance L takes a share of a / L from the depth; one that follows the half-space takes none.
TEST(APatch, FeelsWhereTheBlockEndsOnlyIfItIsHeldThere) {
  const PatchOnABlock small(2, 1.0 / 0.8, 0.3, 6.0), large(2, 1.0 / 0.8, 0.3, 12.0);
  EXPECT_NEAR(small.overExact(), large.overExact(), 0.003);
  const auto missing = [](const PatchOnABlock& block) {
    return 1.0 - block.overExact() / block.heldOverExact();
  };
  EXPECT_NEAR(missing(small), 0.249, 0.003);
  EXPECT_NEAR(missing(small) / missing(large), 2.0, 0.1);
}

}  // namespace
}  // namespace palpate::solver
