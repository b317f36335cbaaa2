// SPDX-License-Identifier: Apache-2.0
#include "tools/solver/series/point_kernel.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <random>
#include <string>
#include <string_view>

#include "../quadratic_box.h"
#include "core/data/model_view.h"

namespace palpate::solver {
namespace {

/// The kernels of the series, with elements of 10 nodes. The reference is the plain loops of
/// integration_point.h: along a ray d = t e forces and energies are polynomials in t, whose coefficients are known.
class QuadraticKernels : public ::testing::TestWithParam<std::string_view> {
 protected:
  static constexpr int kOrder = 2;  // of the fields
  const Law law_ = lawOf(GetParam());
  const QuadraticBox body_{Box{2, 1, 1, Vec3(0.02, 0.01, 0.01)}, law_};
  const std::span<const IntegrationPoint<10>> points_{body_.points};
  const MonomialBasis basis_{3};
  const Vec3 direction_ = Vec3(0.3, -0.5, 0.8).normalized();
  static constexpr double kLength = 0.25;  // m, a power of two as in SeriesSolver: no rounding by it
  LaneVector U_;
  FloatLaneVector V_;

  /// Fields up to a degree are random, others zero.
  PointInput<10> input(int degree) {
    U_.assign(body_.nodes.size() * static_cast<std::size_t>(3 * basis_.size()), Lanes{});
    std::mt19937 random(7);
    std::uniform_real_distribution<double> uniform(-0.1, 0.1);
    for (std::size_t node = 0; node < body_.nodes.size(); ++node)
      for (int k = 0; k < MonomialBasis::size(degree); ++k)
        for (int c = 0; c < 3; ++c)
          for (int lane = 0; lane < kLanes; ++lane) at(node, k, c)[lane] = uniform(random);
    V_.resize(U_.size());
    for (std::size_t i = 0; i < U_.size(); ++i) {
      const MultiIndex& alpha = basis_[static_cast<int>(i / 3) % basis_.size()];
      V_[i] = __builtin_convertvector(U_[i] * std::pow(kLength, alpha[0] + alpha[1] + alpha[2]), FloatLanes);
    }
    return {body_.points.data(), static_cast<int>(body_.points.size()),
            basis_.size(),       U_.data(),
            V_.data(),           kLength};
  }
  Lanes& at(std::size_t node, int k, int c) {
    return U_[(node * static_cast<std::size_t>(basis_.size()) + static_cast<std::size_t>(k)) * 3 +
              static_cast<std::size_t>(c)];
  }
  /// u(t e) of one lane.
  Eigen::VectorXd displacement(double t, int lane) {
    std::vector<double> monomials(static_cast<std::size_t>(basis_.size()));
    basis_.evaluate(t * direction_, monomials);
    Eigen::VectorXd u = Eigen::VectorXd::Zero(body_.size());
    for (std::size_t node = 0; node < body_.nodes.size(); ++node)
      for (int k = 0; k < basis_.size(); ++k)
        for (int c = 0; c < 3; ++c)
          u[static_cast<Eigen::Index>(3 * node) + c] +=
              monomials[static_cast<std::size_t>(k)] * at(node, k, c)[lane];
    return u;
  }
  /// Coefficients of t^0 .. t^12 of what `value` says at t, one a row. Exact for polynomials of that degree.
  template <typename Value>
  static Eigen::MatrixXd coefficients(const Value& value) {
    constexpr int kSamples = 13;  // the energy is of degree 6 in F, and F of degree 2 in t
    constexpr double kLargest = 0.05;
    Eigen::MatrixXd powers(kSamples, kSamples), values;
    for (int i = 0; i < kSamples; ++i) {
      const double t = std::cos(M_PI * i / (kSamples - 1));
      for (int n = 0; n < kSamples; ++n) powers(i, n) = std::pow(t, n);
      const Eigen::VectorXd sample = value(kLargest * t);
      if (i == 0) values.resize(kSamples, sample.size());
      values.row(i) = sample.transpose();
    }
    Eigen::MatrixXd result = powers.fullPivLu().solve(values);
    for (int n = 0; n < kSamples; ++n) result.row(n) /= std::pow(kLargest, n);
    return result;
  }
};

INSTANTIATE_TEST_SUITE_P(Material, QuadraticKernels, ::testing::ValuesIn(kLaws), [](const auto& test) {
  std::string name(test.param);
  std::erase(name, '-');
  return name;
});

TEST_P(QuadraticKernels, LowerOrdersMakeTheForceOfTheNextDegree) {
  const CauchyProduct product(basis_, basis_.order());
  for (const int degree : {2, 3}) {
    const PointInput<10> fields = input(degree - 1);
    const int first = MonomialBasis::begin(degree), last = MonomialBasis::begin(degree + 1);
    LaneVector r(body_.nodes.size() * static_cast<std::size_t>(3 * (last - first)), Lanes{});
    point_kernel::assembleAll(fields, product, first, last, r.data());
    std::vector<double> monomials(static_cast<std::size_t>(basis_.size()));
    basis_.evaluate(direction_, monomials);
    for (const int lane : {0, 3, kLanes - 1}) {
      const Eigen::VectorXd wanted =
          coefficients([&](double t) {
            Eigen::VectorXd f = Eigen::VectorXd::Zero(body_.size());
            const Eigen::VectorXd u = displacement(t, lane);
            std::visit([&](auto law) { addInternalForce<decltype(law)>(points_, u, f); }, law_);
            return f;
          }).row(degree);
      Eigen::VectorXd found = Eigen::VectorXd::Zero(body_.size());
      for (Eigen::Index i = 0; i < found.size(); ++i)
        for (int k = first; k < last; ++k)
          found[i] += monomials[static_cast<std::size_t>(k)] *
                      r[static_cast<std::size_t>(((i / 3) * (last - first) + k - first) * 3 + i % 3)][lane];
      ASSERT_GT(wanted.norm(), 0.0);
      EXPECT_LT((found - wanted).norm(), 1e-8 * wanted.norm()) << "degree " << degree << ", lane " << lane;
    }
  }
}

TEST_P(QuadraticKernels, EnergyHasTheCoefficientsOfTheEnergyOfTheFields) {
  const PointInput<10> fields = input(kOrder);
  const MonomialBasis strains(2 * kOrder), energies(2 * kOrder + 1);
  const CauchyProduct factors(strains, kOrder);
  const CauchyRows rows(CauchyProduct(energies, 2 * kOrder), 0);
  LaneVector W(static_cast<std::size_t>(energies.size()), Lanes{});
  point_kernel::energyAll(fields, basis_.size(), factors, rows, energies.size(), W.data());
  std::vector<double> monomials(static_cast<std::size_t>(energies.size()));
  energies.evaluate(direction_, monomials);
  for (const int lane : {0, kLanes - 1}) {
    const Eigen::VectorXd wanted = coefficients([&](double t) {
      const Eigen::VectorXd u = displacement(t, lane);
      return Eigen::VectorXd::Constant(
          1, std::visit([&](auto law) { return elasticEnergy<decltype(law)>(points_, u); }, law_));
    });
    for (int degree = 2; degree <= energies.order(); ++degree) {
      double found = 0.0;
      for (int k = energies.begin(degree); k < energies.begin(degree + 1); ++k)
        found += monomials[static_cast<std::size_t>(k)] * W[static_cast<std::size_t>(k)][lane] *
                 std::pow(kLength, -degree);
      EXPECT_NEAR(found, wanted[degree], 2e-5 * std::abs(wanted[degree])) << "degree " << degree;
    }
  }
}

TEST_P(QuadraticKernels, DetFIsThatOfTheSumAndWithinItsBound) {
  const PointInput<10> fields = input(kOrder);
  const double radius = 5e-3;
  LaneVector monomials(static_cast<std::size_t>(basis_.size())), summed(body_.nodes.size() * 3);
  std::vector<double> unit(monomials.size());
  basis_.evaluate(radius * direction_, unit);
  for (std::size_t k = 0; k < unit.size(); ++k) monomials[k] = unit[k] - Lanes{};
  FloatLaneVector powers, bounds(static_cast<std::size_t>(fields.point_count));
  for (int degree = 1; degree <= basis_.order(); ++degree)
    powers.push_back(static_cast<float>(std::pow(radius / kLength, degree)) - FloatLanes{});
  for (std::size_t i = 0; i < summed.size(); ++i) {
    summed[i] = Lanes{};
    for (std::size_t k = 0; k < unit.size(); ++k)
      summed[i] += monomials[k] * at(i / 3, static_cast<int>(k), static_cast<int>(i % 3));
  }
  PointInput<10> sum = fields;
  sum.U = summed.data();
  sum.coefficients = 1;
  Lanes least = Lanes{} + 1e9;
  point_kernel::leastDetAll(sum, least);
  for (const int lane : {0, kLanes - 1}) {
    double smallest = 1e9;
    for (int n = 0; n < fields.point_count; ++n) {
      const Mat3 H = displacementGradient(points_[static_cast<std::size_t>(n)], displacement(radius, lane));
      smallest = std::min(smallest, (Mat3::Identity() + H).determinant());
      FloatLanes& bound = bounds[static_cast<std::size_t>(n)];
      point_kernel::boundPoint(fields, n, powers.data(), bound);
      EXPECT_GE(static_cast<double>(bound[lane]) * (1.0 + 1e-6), H.norm());
    }
    EXPECT_NEAR(least[lane], smallest, 1e-12);
  }
}

}  // namespace
}  // namespace palpate::solver
