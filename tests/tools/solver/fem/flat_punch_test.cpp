// SPDX-License-Identifier: Apache-2.0
// A rigid flat punch on a large block against the closed form of the half-space. Lengths in units of the punch's radius a,
// moduli in units of E.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "../half_space.h"
#include "../supported_body.h"
#include "tools/mesh/quadratic.h"

namespace palpate::solver {
namespace {

using std::numbers::pi;

/// A quarter of a cylinder of the half-space, punched round its axis. Its cells lie in rings, finest at the punch's edge, where
/// the pressure is infinite. On the quarter's flat sides nothing moves across them.
class FlatPunch {
 public:
  struct Shape {
    int order;  ///< of the elements
    double nu;
    double edge{0.1};    ///< width of the cells at the punch's edge
    double radius{6.0};  ///< and depth of the cylinder
  };

  explicit FlatPunch(const Shape& shape)
      : nu_(shape.nu), mesh_(meshOf(shape)), body_(mesh_, {{1.0, shape.nu}}, given()) {}

  /// Force over F = 2 E a delta / (1 - nu^2) (Johnson, Section 3.4), of the block that is held at the cut.
  [[nodiscard]] double heldOverExact() const {
    return forceOf(body_.solve(pressed(), body_.zero())) / exact();
  }
  /// Of the block that follows the half-space there: F = delta F(pressed, held) + F F(not pressed, cut moved by 1 N).
  [[nodiscard]] double overExact() const {
    const Eigen::VectorXd moved =
        halfSpaceAt(mesh_.groups.at("cut"), mesh_.nodes, pressure(), body_.model().material().elasticity);
    return heldOverExact() / (1.0 - forceOf(body_.solve(moved, body_.zero())));
  }

 private:
  static mesh::TetMesh meshOf(const Shape& shape) {
    constexpr double kGrowth = 1.8;
    const std::vector<double> inward = growingSteps(shape.edge, 0.0, kGrowth, 1.0),
                              outward = growingSteps(shape.edge, 0.0, kGrowth, shape.radius - 1.0),
                              down = growingSteps(shape.edge, 0.0, kGrowth, shape.radius);
    std::vector<double> ring;
    for (auto r = inward.rbegin(); r != inward.rend(); ++r) ring.push_back(1.0 - *r);
    for (std::size_t i = 1; i < outward.size(); ++i) ring.push_back(1.0 + outward[i]);
    mesh::TetMesh mesh = blockOf(ring, ring, down);
    for (std::size_t node = 0; node < mesh.nodes.size(); ++node) {
      const std::size_t i = node % ring.size(), j = node / ring.size() % ring.size(), k = std::max(i, j);
      Vec3& X = mesh.nodes[node];
      if (k > 0) {  // squares become circles, with nodes at equal angles
        const double part = 0.25 * pi * static_cast<double>(std::min(i, j)) / static_cast<double>(k);
        const double angle = i >= j ? part : 0.5 * pi - part;
        X.head<2>() = ring[k] * Eigen::Vector2d(std::cos(angle), std::sin(angle));
      }
      const auto in = [&](const char* group) {
        mesh.groups[group].push_back(static_cast<std::int32_t>(node));
      };
      if (k + 1 == ring.size() || X.z() == shape.radius) in("cut");
      if (ring[k] <= 1.0 && X.z() == 0.0) in("pressed");
    }
    return shape.order == 2 ? mesh::quadraticOf(mesh) : mesh;
  }
  [[nodiscard]] std::vector<bool> given() const {
    std::vector<bool> given;
    for (const Vec3& X : mesh_.nodes) given.insert(given.end(), {X.x() < 1e-9, X.y() < 1e-9, false});
    for (const std::int32_t node : mesh_.groups.at("cut")) std::fill_n(given.begin() + 3 * node, 3, true);
    for (const std::int32_t node : mesh_.groups.at("pressed"))
      given[3 * static_cast<std::size_t>(node) + 2] = true;
    return given;
  }
  /// By delta = 1.
  [[nodiscard]] Eigen::VectorXd pressed() const {
    Eigen::VectorXd u = body_.zero();
    for (const std::int32_t node : mesh_.groups.at("pressed")) u[3 * node + 2] = 1.0;
    return u;
  }
  /// On the whole punch, of which the body is a quarter.
  [[nodiscard]] double forceOf(const Eigen::VectorXd& u) const { return 4.0 * pressed().dot(body_.force(u)); }
  [[nodiscard]] double exact() const { return 2.0 / (1.0 - nu_ * nu_); }
  /// p(r) = F / (2 pi a sqrt(a^2 - r^2)) (Johnson, Section 3.4) in equal parts of t, r = a sin t, and of the angle.
  static std::vector<PointLoad> pressure() {
    constexpr int kRings = 20, kAngles = 24;
    std::vector<PointLoad> loads;
    for (int i = 0; i < kRings; ++i)
      for (int j = 0; j < kAngles; ++j) {
        const double t = 0.5 * pi * (i + 0.5) / kRings, dt = 0.5 * pi / kRings,
                     angle = 2.0 * pi * (j + 0.5) / kAngles;
        loads.push_back(
            {std::sin(t) * Vec3(std::cos(angle), std::sin(angle), 0.0), std::sin(t) * dt / kAngles});
      }
    return loads;
  }

  double nu_;
  mesh::TetMesh mesh_;
  SupportedBody body_;
};

// What is left is the infinite pressure at the edge, too stiff, less 0.3 % for the circle, whose quarter is eight straight lines.
TEST(AFlatPunch, OnQuadraticElementsHasTheForceOfTheClosedForm) {
  EXPECT_NEAR(FlatPunch({2, 0.3}).overExact(), 1.010, 0.002);
  EXPECT_NEAR(FlatPunch({2, 0.48}).overExact(), 1.015, 0.002);
}

TEST(AFlatPunch, OnFinerElementsComesNearer) {
  EXPECT_NEAR(FlatPunch({.order = 2, .nu = 0.48, .edge = 0.04}).overExact(), 1.0067, 0.002);
}

TEST(AFlatPunch, OnLinearElementsIsHeldUpByThemMoreSoNearIncompressibility) {
  EXPECT_NEAR(FlatPunch({1, 0.3}).overExact(), 1.125, 0.005);
  EXPECT_NEAR(FlatPunch({1, 0.48}).overExact(), 1.263, 0.005);
}

// A block that is held at a distance L takes a share of a / L from the depth; one that follows the half-space takes none.
TEST(AFlatPunch, FeelsWhereTheBlockEndsOnlyIfItIsHeldThere) {
  const FlatPunch small({2, 0.3}), large({.order = 2, .nu = 0.3, .radius = 12.0});
  EXPECT_NEAR(small.overExact(), large.overExact(), 0.002);
  const auto missing = [](const FlatPunch& punch) { return 1.0 - punch.overExact() / punch.heldOverExact(); };
  EXPECT_NEAR(missing(small), 0.156, 0.003);
  EXPECT_NEAR(missing(small) / missing(large), 2.0, 0.1);
}

}  // namespace
}  // namespace palpate::solver
