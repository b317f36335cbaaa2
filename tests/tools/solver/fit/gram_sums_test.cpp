// SPDX-License-Identifier: Apache-2.0
#include "tools/solver/fit/gram_sums.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "tools/solver/fit/normal_equations.h"
#include "tools/solver/fit/spatial_order.h"

namespace palpate::solver {
namespace {

class GramSumsOf : public ::testing::TestWithParam<Eigen::Index> {};  // columns of a matrix
INSTANTIATE_TEST_SUITE_P(FewAndMany, GramSumsOf, ::testing::Values(3, 5));

TEST_P(GramSumsOf, EqualTheSumsOfTheMatrices) {
  constexpr Eigen::Index kN = 17, kCount = 600;
  const Eigen::Index width = GetParam();
  const Eigen::MatrixXf columns = Eigen::MatrixXf::Random(kN, width * kCount);
  const auto factor = [](std::int32_t i, std::int32_t r) {
    if (r == 9 || (i - r) % (1 + 7 * r) != 0) return 0.0F;
    return static_cast<float>(std::sin(3.0 * i + r));
  };
  std::vector<std::int32_t> inputs(kCount), receivers(10);
  std::iota(inputs.begin(), inputs.end(), 0);
  std::iota(receivers.begin(), receivers.end(), 0);
  GramSums::Work work;
  GramSums(columns, width).sum(inputs, receivers, factor, work);
  ASSERT_EQ(work.sums.cols(), 10);
  for (const std::int32_t r : receivers) {
    Eigen::MatrixXd direct = Eigen::MatrixXd::Zero(kN, kN), sum;
    double size = 0.0;
    for (const std::int32_t i : inputs) {
      const Eigen::MatrixXd B = columns.middleCols(i * width, width).cast<double>();
      direct += double{factor(i, r)} * B * B.transpose();
      size += std::abs(double{factor(i, r)}) * B.squaredNorm();
    }
    addPacked(work.sums.col(r).data(), Eigen::MatrixXd::Zero(kN, kN), sum);
    for (Eigen::Index i = 0; i < kN; ++i)
      for (Eigen::Index j = 0; j <= i; ++j) EXPECT_NEAR(sum(i, j), direct(i, j), 1e-5 * size);
  }
}

TEST(NormalEquations, AreRegularizedOrRefused) {
  Eigen::MatrixXd N = Eigen::MatrixXd::Zero(3, 3);
  N.diagonal() << 1e-12, 2e-12, -1e-24;  // as rounding leaves it
  const Eigen::Vector3d b(1e-12, 2e-12, 0.0), x0(0.0, 0.0, 7.0);
  const Eigen::Vector3d x = NormalEquations(N, 1e-12, "node 4").solve(b, x0);
  EXPECT_LT((x - Eigen::Vector3d(1.0, 1.0, 7.0)).cwiseAbs().maxCoeff(), 1e-4);
  N(2, 2) = -1e-12;
  try {
    NormalEquations(N, 1e-12, "node 4");
    FAIL() << "a matrix that is not positive definite";
  } catch (const FitError& error) {
    EXPECT_NE(std::string(error.what()).find("node 4"), std::string::npos) << error.what();
  }
}

TEST(SpatialOrder, KeepsNeighboursTogether) {
  std::vector<Vec3> places;
  for (int i = 0; i < 1024; ++i) places.emplace_back((i * 37) % 32, ((i * 37) % 1024) / 32, 0.0);
  std::vector<std::int32_t> order = spatialOrder(places);
  for (std::size_t first = 0; first < order.size(); first += 64)
    for (std::size_t k = first; k < first + 64; ++k)
      EXPECT_LE((places[static_cast<std::size_t>(order[k])] - places[static_cast<std::size_t>(order[first])])
                    .cwiseAbs()
                    .maxCoeff(),
                8.0);
  std::sort(order.begin(), order.end());
  for (std::size_t i = 0; i < order.size(); ++i) EXPECT_EQ(order[i], static_cast<std::int32_t>(i));
}

}  // namespace
}  // namespace palpate::solver
