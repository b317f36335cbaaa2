// SPDX-License-Identifier: Apache-2.0
#include "tools/solver/series/series.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <stdexcept>
#include <string>

#include "block_series.h"
#include "core/data/model_view.h"

namespace palpate::solver {
namespace {

/// Relative error that a coefficient of degree n may have: with fields of degree p, those above p come from energies
/// that are summed in float32.
constexpr double precision(int degree, int field_order) {
  return degree <= field_order ? 1e-9 : 2e-5;
}

class SeriesOfEveryLaw : public BlockSeries, public ::testing::WithParamInterface<std::string_view> {
 protected:
  Case c{box_, 160e3, lawOf(GetParam())};
};

INSTANTIATE_TEST_SUITE_P(Material, SeriesOfEveryLaw, ::testing::ValuesIn(kLaws), [](const auto& test) {
  std::string name(test.param);
  std::erase(name, '-');
  return name;
});

/// Halves d from `largest`, m.
void expectAgreementWithNewton(const BlockSeries::Case& c, double largest) {
  SeriesSolver series(c.model, c.factor, BlockSeries::kOrder);
  series.solve(c.patches);
  NewtonSolver newton(c.model);
  const Vec3 direction = Vec3(0.3, -0.5, -0.8).normalized();
  for (int lane = 0; lane < 3; ++lane) {
    std::array<double, 2> force_error{}, field_error{};
    for (std::size_t half = 0; half < 2; ++half) {
      const Vec3 d = (half == 0 ? largest : 0.5 * largest) * direction;
      const NewtonResult truth = newton.solvePatch(c.patches[static_cast<std::size_t>(lane)], d, {});
      force_error[half] = (BlockSeries::force(series, lane, d) - truth.force).norm() / truth.force.norm();
      field_error[half] =
          (BlockSeries::field(series, lane, d, c.model) - truth.u).cwiseAbs().maxCoeff() / d.norm();
    }
    EXPECT_LT(field_error[0], 5e-3);
    EXPECT_LT(force_error[0], 1e-3);
    // The relative error of a series of degree p falls with d^p; halving d, by 2^4 for the field, 2^6 for the
    // force.
    EXPECT_LT(field_error[1], field_error[0] / 12.0);
    EXPECT_LT(force_error[1], force_error[0] / 40.0);
  }
}

/// Fields of a low degree give the same force as those of a high one.
void expectTheSameForce(const BlockSeries::Case& c, const SeriesOrders& few, const SeriesOrders& many) {
  SeriesSolver low(c.model, c.factor, few), high(c.model, c.factor, many);
  low.solve(c.patches);
  high.solve(c.patches);
  ASSERT_EQ(low.answerBasis().order(), few.answer);
  for (int lane = 0; lane < 3; ++lane)
    for (int degree = 1; degree <= std::min(few.answer, many.answer); ++degree) {
      double scale = 0.0, worst = 0.0;
      for (int k = low.answerBasis().begin(degree); k < low.answerBasis().begin(degree + 1); ++k) {
        scale = std::max(scale, high.answer(lane, k).norm());
        worst = std::max(worst, (low.answer(lane, k) - high.answer(lane, k)).norm());
      }
      EXPECT_LT(worst, precision(degree, few.fields) * scale) << "degree " << degree;
    }
}

TEST_P(SeriesOfEveryLaw, AgreesWithNewtonToItsOrder) {
  expectAgreementWithNewton(c, 4e-3);
}

/// A block of two laws, of which one part is stiff, on a bed of springs.
class SeriesOfAMixedBody : public BlockSeries {
 protected:
  static Material material(const Box& box) {
    Material mixed{{160e3, 0.45}};
    mixed.regions = {{"soft", {160e3, 0.45}, StVenantKirchhoff{}},
                     {"stiff", {800e3, 0.3}, StableNeoHookean{}}};
    for (std::size_t e = 0; e < box.tetrahedra().size(); ++e)
      mixed.region_of_element.push_back(e < box.tetrahedra().size() / 3 ? 1 : 0);
    return mixed;
  }
  static std::vector<Spring> bed(const Box& box) {
    std::vector<Spring> springs;
    for (const std::int32_t node : box.face(2, false)) springs.push_back({node, 2e3});
    return springs;
  }
  Case c{box_, material(box_), bed(box_)};
};

TEST_F(SeriesOfAMixedBody, AgreesWithNewtonToItsOrder) {
  expectAgreementWithNewton(c, 2e-3);
}

TEST_F(SeriesOfAMixedBody, FieldsOfDegree3GiveTheForceToDegree6) {
  expectTheSameForce(c, {3, 6}, {6, 6});
}

TEST_P(SeriesOfEveryLaw, FieldsOfDegree3GiveTheForceToDegree6) {
  expectTheSameForce(c, {3, 6}, {6, 6});
}

TEST_P(SeriesOfEveryLaw, FieldsOfDegree4GiveTheForceToDegree8) {
  expectTheSameForce(c, {4, 8}, {7, 7});
  expectTheSameForce(c, {4, 8}, {5, 8});
}

/// Of fields beyond half the force's degree the energy needs nothing.
TEST_P(SeriesOfEveryLaw, FieldsOfDegree3GiveTheForceToDegree6BesideHigherOnes) {
  expectTheSameForce(c, {4, 6}, {6, 6});
  expectTheSameForce(c, {5, 6}, {6, 6});
}

TEST_F(BlockSeries, RefusesAForceBeyondWhatItsFieldsGive) {
  const Case c(box_, 160e3);
  for (const SeriesOrders& orders : {SeriesOrders{3, 7}, {3, 2}, {5, 9}, {0, 0}, {8, 8}})
    EXPECT_THROW(SeriesSolver(c.model, c.factor, orders), std::invalid_argument)
        << orders.fields << ' ' << orders.answer;
}

TEST_F(BlockSeries, PatchMovesByExactlyD) {
  Case c(box_, 160e3);
  SeriesSolver series(c.model, c.factor, kOrder);
  series.solve(c.patches);
  for (int k = 0; k < series.basis().size(); ++k) {
    Eigen::VectorXd u(3 * c.model.nodeCount());
    for (int node = 0; node < c.model.nodeCount(); ++node)
      u.segment<3>(3 * node) = series.displacement(1, k, node);
    const Vec3 expected = k < 3 ? Vec3(Vec3::Unit(k)) : Vec3(Vec3::Zero());
    EXPECT_LT((c.patches[1].average(u) - expected).norm(), 1e-10 * std::max(1.0, u.cwiseAbs().maxCoeff()))
        << k;
  }
}

TEST_P(SeriesOfEveryLaw, ForceIsGradientOfEnergy) {
  SeriesSolver series(c.model, c.factor, kOrder);
  series.solve(c.patches);
  const MonomialBasis& basis = series.answerBasis();
  for (int lane = 0; lane < 3; ++lane)
    for (int k = 0; k < basis.size(); ++k)
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < i; ++j) {
          // d f_i / d d_j = d f_j / d d_i, coefficient of d^gamma with gamma = alpha_k - e_i.
          MultiIndex gamma = basis[k];
          if (gamma[static_cast<std::size_t>(i)] == 0) continue;
          --gamma[static_cast<std::size_t>(i)];
          MultiIndex with_j = gamma;
          ++with_j[static_cast<std::size_t>(j)];
          const int l = basis.find(with_j);
          const double left = (gamma[static_cast<std::size_t>(i)] + 1) * series.answer(lane, k)[j];
          const double right = (gamma[static_cast<std::size_t>(j)] + 1) * series.answer(lane, l)[i];
          double scale = 0.0;
          for (int m = basis.begin(gamma[0] + gamma[1] + gamma[2] + 1);
               m < basis.begin(gamma[0] + gamma[1] + gamma[2] + 2); ++m)
            scale = std::max(scale, series.answer(lane, m).norm());
          EXPECT_NEAR(left, right, 1e-9 * scale);
        }
}

TEST_F(BlockSeries, DisplacementDoesNotDependOnYoungsModulusAndForceIsProportional) {
  Case soft(box_, 2e3), stiff(box_, 160e3);
  SeriesSolver a(soft.model, soft.factor, kOrder), b(stiff.model, stiff.factor, kOrder);
  a.solve(soft.patches);
  b.solve(stiff.patches);
  for (int k = 0; k < a.basis().size(); ++k) {
    EXPECT_LT((80.0 * a.answer(0, k) - b.answer(0, k)).norm(), 1e-9 * b.answer(0, k).norm());
    const int node = box_.node(5, 3, 4);
    EXPECT_LT((a.displacement(0, k, node) - b.displacement(0, k, node)).norm(),
              1e-9 * (1.0 + b.displacement(0, k, node).norm()));
  }
}

TEST_F(BlockSeries, DrivenByForceAgreesWithNewtonUnderDeadLoadToItsOrder) {
  Case c(box_, 160e3);
  SeriesSolver series(c.model, c.factor, 3, SeriesKind::kForce);
  series.solve(c.patches);
  NewtonSolver newton(c.model);
  for (int lane = 0; lane < 3; ++lane) {
    std::array<double, 2> answer_error{}, field_error{};
    for (std::size_t half = 0; half < 2; ++half) {
      const double size = (half == 0 ? 4e-3 : 2e-3) / series.answer(lane, 2).norm();
      const Vec3 f = size * Vec3(0.3, -0.5, -0.8).normalized();
      Eigen::VectorXd load = Eigen::VectorXd::Zero(3 * c.model.nodeCount());
      const Patch& patch = c.patches[static_cast<std::size_t>(lane)];
      patch.addForce(f, load);
      const NewtonResult truth = newton.solveLoad(load, {});
      const Vec3 d = patch.average(truth.u);
      field_error[half] =
          (field(series, lane, f, c.model) - truth.u).cwiseAbs().maxCoeff() / truth.u.cwiseAbs().maxCoeff();
      const Vec3 answer = sum(series.answerBasis(), f, [&](int k) { return series.answer(lane, k); });
      answer_error[half] = (answer - d).norm() / d.norm();
    }
    EXPECT_LT(field_error[0], 2e-2);
    // Relative errors fall with f^3 in the field, f^6 in the displacement of the patch.
    EXPECT_LT(field_error[1], field_error[0] / 6.5);
    EXPECT_GT(field_error[1], field_error[0] / 11.0);
    EXPECT_LT(answer_error[1], answer_error[0] / 40.0);
  }
}

TEST_F(BlockSeries, DisplacementsOfAForceSeriesArePatchAveragesAndFieldsOfDegree3GiveThemToDegree6) {
  Case c(box_, 160e3);
  SeriesSolver low(c.model, c.factor, 3, SeriesKind::kForce), high(c.model, c.factor, 6, SeriesKind::kForce);
  low.solve(c.patches);
  high.solve(c.patches);
  for (int degree = 1; degree <= 6; ++degree) {
    double scale = 0.0, worst = 0.0;
    for (int k = low.answerBasis().begin(degree); k < low.answerBasis().begin(degree + 1); ++k) {
      Eigen::VectorXd u(3 * c.model.nodeCount());
      for (int node = 0; node < c.model.nodeCount(); ++node)
        u.segment<3>(3 * node) = high.displacement(1, k, node);
      const Vec3 average = c.patches[1].average(u);
      scale = std::max(scale, average.norm());
      worst = std::max({worst, (low.answer(1, k) - average).norm(), (high.answer(1, k) - average).norm()});
    }
    EXPECT_LT(worst, precision(degree, 3) * scale) << "degree " << degree;
  }
}

// f(d(t f)) = t f: as truncated power series in t, every coefficient beyond the first vanishes.
TEST_F(BlockSeries, DrivenByForceAndByDisplacementAreInverseToEachOther) {
  constexpr int kDegree = 6;
  Case c(box_, 160e3);
  SeriesSolver by_d(c.model, c.factor, 3), by_f(c.model, c.factor, 3, SeriesKind::kForce);
  by_d.solve(c.patches);
  by_f.solve(c.patches);
  for (int lane = 0; lane < 3; ++lane)
    for (const Vec3& direction : {Vec3(0, 0, -1), Vec3(0.6, 0.0, 0.8), Vec3(0.48, -0.6, 0.64)}) {
      const double f_ref = 0.002 / by_f.answer(lane, 2).norm();
      std::array<Vec3, kDegree + 1> d{}, f{};  // truncated power series in t, d(t) = d(t f_ref direction)
      d.fill(Vec3::Zero());
      for (int k = 0; k < by_f.answerBasis().size(); ++k) {
        const MultiIndex& a = by_f.answerBasis()[k];
        const Vec3 x = f_ref * direction;
        d[static_cast<std::size_t>(a[0] + a[1] + a[2])] +=
            std::pow(x[0], a[0]) * std::pow(x[1], a[1]) * std::pow(x[2], a[2]) * by_f.answer(lane, k);
      }
      f.fill(Vec3::Zero());
      for (int k = 0; k < by_d.answerBasis().size(); ++k) {
        std::array<double, kDegree + 1> monomial{1.0};  // d_x^a d_y^b d_z^c as a series in t
        for (std::size_t axis = 0; axis < 3; ++axis)
          for (int power = 0; power < by_d.answerBasis()[k][axis]; ++power) {
            std::array<double, kDegree + 1> product{};
            for (std::size_t i = 0; i <= kDegree; ++i)
              for (std::size_t j = 0; i + j <= kDegree; ++j)
                product[i + j] += monomial[i] * d[j][static_cast<Eigen::Index>(axis)];
            monomial = product;
          }
        for (std::size_t i = 0; i <= kDegree; ++i) f[i] += monomial[i] * by_d.answer(lane, k);
      }
      EXPECT_LT((f[1] - f_ref * direction).norm(), 1e-10 * f_ref);
      for (std::size_t degree = 2; degree <= kDegree; ++degree)
        EXPECT_LT(f[degree].norm(), precision(static_cast<int>(degree), 3) * f_ref) << "degree " << degree;
    }
}

}  // namespace
}  // namespace palpate::solver
