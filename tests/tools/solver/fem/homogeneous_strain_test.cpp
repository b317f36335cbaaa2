// SPDX-License-Identifier: Apache-2.0
// The patch test of finite elements (B. M. Irons): whatever the mesh, a homogeneous deformation is met exactly. For every law
// and both kinds of element.
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <random>
#include <string>
#include <string_view>
#include <tuple>

#include "../boxes.h"
#include "../quadratic_box.h"
#include "../supported_body.h"
#include "core/data/model_view.h"

namespace palpate::solver {
namespace {

using OrderAndLaw = std::tuple<int, std::string_view>;

/// A box whose inner nodes were moved at random.
class IrregularBox : public ::testing::TestWithParam<OrderAndLaw> {
 protected:
  IrregularBox() {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> part(-0.25, 0.25);
    mesh_.nodes = box_.nodes();
    mesh_.node_tags.resize(mesh_.nodes.size());
    mesh_.tetrahedra = box_.tetrahedra();
    const Vec3 cell = box_.size / 3.0;
    for (Vec3& X : mesh_.nodes)
      if (inside(X)) X += cell.cwiseProduct(Vec3{part(random), part(random), part(random)});
    if (order_ == 2) mesh_ = mesh::quadraticOf(mesh_);
  }
  [[nodiscard]] FeModel model() const {
    return {mesh_.nodes, {mesh_.tetrahedra, mesh_.midsides}, {}, {kElasticity, law_}};
  }
  [[nodiscard]] bool inside(const Vec3& X) const {
    return X.minCoeff() > 1e-9 && (box_.size - X).minCoeff() > 1e-9;
  }
  [[nodiscard]] Eigen::VectorXd homogeneous() const {
    Eigen::VectorXd u(3 * static_cast<Eigen::Index>(mesh_.nodes.size()));
    for (std::size_t i = 0; i < mesh_.nodes.size(); ++i)
      u.segment<3>(3 * static_cast<Eigen::Index>(i)) = H_ * mesh_.nodes[i];
    return u;
  }
  /// P of H, written out for each law.                                           docs/design.md, Series
  [[nodiscard]] Mat3 stress() const {
    const auto [lambda, mu] = kElasticity.lame();
    const Mat3 F = Mat3::Identity() + H_;
    if (std::holds_alternative<StVenantKirchhoff>(law_)) {
      const Mat3 E = 0.5 * (F.transpose() * F - Mat3::Identity());
      return F * (lambda * E.trace() * Mat3::Identity() + 2.0 * mu * E);
    }
    const double J = F.determinant();
    return mu * F + ((lambda + mu) * (J - 1.0) - mu) * J * F.inverse().transpose();
  }

  static constexpr Elasticity kElasticity{160e3, 0.48};
  const int order_{std::get<0>(GetParam())};
  const Law law_{lawOf(std::get<1>(GetParam()))};
  const Box box_{3, 3, 3, Vec3(0.03, 0.02, 0.04)};
  const Mat3 H_ = (Mat3() << 0.1, 0.05, -0.02, 0.03, -0.08, 0.04, 0.0, 0.06, 0.12).finished();
  mesh::TetMesh mesh_;
};

TEST_P(IrregularBox, HasTheSameStressInEveryPoint) {
  const FeModel body = model();
  const Eigen::VectorXd u = homogeneous();
  const Mat3 wanted = stress();
  std::visit(
      [&](const auto& points) {
        for (const auto& point : points)
          std::visit(
              [&](auto law) {
                EXPECT_LT((law.stress(point.lame, displacementGradient(point, u)) - wanted).norm(),
                          1e-11 * wanted.norm());
              },
              point.law);
      },
      body.points());
}

TEST_P(IrregularBox, HasNoForceInsideAndThatStressOnItsSides) {
  const Eigen::VectorXd f = model().internalForce(homogeneous());
  const Mat3 P = stress();
  Mat3 work = Mat3::Zero();
  int inner = 0;
  for (std::size_t i = 0; i < mesh_.nodes.size(); ++i) {
    const auto force = f.segment<3>(3 * static_cast<Eigen::Index>(i));
    if (inside(mesh_.nodes[i])) {
      EXPECT_LT(force.norm(), 1e-12 * f.cwiseAbs().maxCoeff()) << "node " << i;
      ++inner;
    }
  }
  EXPECT_EQ(inner, order_ == 2 ? 125 : 8);
  // Virtual work of linear motions: sum f_i X_i^T = V P.
  for (std::size_t i = 0; i < mesh_.nodes.size(); ++i)
    work += f.segment<3>(3 * static_cast<Eigen::Index>(i)) * mesh_.nodes[i].transpose();
  EXPECT_LT((work - box_.size.prod() * P).norm(), 1e-12 * work.norm());
}

TEST_P(IrregularBox, FollowsItsSurfaceInside) {
  std::vector<bool> given;
  const Eigen::VectorXd u = homogeneous();
  Eigen::VectorXd at_surface = u;
  for (std::size_t i = 0; i < mesh_.nodes.size(); ++i) {
    given.insert(given.end(), 3, !inside(mesh_.nodes[i]));
    if (inside(mesh_.nodes[i])) at_surface.segment<3>(3 * static_cast<Eigen::Index>(i)).setZero();
  }
  const SupportedBody body(mesh_, {kElasticity, law_}, given);
  EXPECT_LT((body.solve(at_surface, body.zero()) - u).norm(), 1e-11 * u.norm());
}

std::string nameOf(const ::testing::TestParamInfo<OrderAndLaw>& test) {
  std::string name = std::get<0>(test.param) == 2 ? "quadratic" : "linear";
  name += std::get<1>(test.param);
  std::erase(name, '-');
  return name;
}

INSTANTIATE_TEST_SUITE_P(Both, IrregularBox,
                         ::testing::Combine(::testing::Values(1, 2), ::testing::ValuesIn(kLaws)), nameOf);

}  // namespace
}  // namespace palpate::solver
