// SPDX-License-Identifier: Apache-2.0
#include "tools/solver/fit/far_field.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "../boxes.h"

namespace palpate::solver {
namespace {

constexpr double kRho = 0.012;

/// Fields that are smooth far from s and steep near it, at the nodes of a box.
class SteepFields : public ::testing::Test {
 protected:
  SteepFields() {
    for (std::size_t s = 0; s < surface_.positions.size(); ++s) {
      std::vector<float> fields;
      for (int k = 0; k < basis_.size(); ++k)
        for (const Vec3& X : surface_.positions)
          for (int c = 0; c < 3; ++c)
            fields.push_back(static_cast<float>(value(X, surface_.positions[s], k, c)));
      table_.write(s, fields);
      weights_.push_back(fitWeights(surface_, surface_.positions[s], kRho));
    }
  }

  static double value(const Vec3& X, const Vec3& s, int k, int c) {
    const double r = (X - s).norm();
    return (k + 1) * std::exp(-r / 0.01) * (c == k % 3 ? 1.0 : 0.2) + std::cos(40.0 * X.x() + 30.0 * s.y());
  }

  [[nodiscard]] FarField fit(int modes, int sweeps, int workers = 1) const {
    FitOptions options;
    options.modes = modes;
    options.sweeps = sweeps;
    options.workers = workers;
    options.quiet = true;
    return fitFarField({table_, basis_, surface_.areas, weights_, radii_, 1.0}, options);
  }

  /// Largest error at nodes outside rho, over all positions and coefficients.
  [[nodiscard]] double largestFarError(const FarField& far) const {
    double largest = 0.0;
    for (std::size_t s = 0; s < surface_.positions.size(); ++s)
      for (int k = 0; k < basis_.size(); ++k) {
        const Eigen::VectorXf u = far.X * far.Y.col(static_cast<Eigen::Index>(s) * basis_.size() + k);
        for (std::size_t i = 0; i < surface_.positions.size(); ++i)
          for (int c = 0; c < 3; ++c)
            if ((surface_.positions[i] - surface_.positions[s]).norm() >= kRho)
              largest = std::max(largest, std::abs(value(surface_.positions[i], surface_.positions[s], k, c) -
                                                   double{u[static_cast<Eigen::Index>(3 * i) + c]}));
      }
    return largest;
  }

  const Box box_{6, 5, 4, Vec3(0.06, 0.05, 0.04)};
  const FeModel model_{box_.clamped({{160e3, 0.45}})};
  const PatchSurface surface_{box_.surface(model_)};
  const MonomialBasis basis_{1};
  const std::vector<double> radii_ = std::vector<double>(surface_.positions.size(), 1.0);
  FieldTable table_{std::filesystem::temp_directory_path(), surface_.positions.size(), 3,
                    3 * surface_.positions.size()};
  std::vector<FitWeights> weights_;
};

TEST_F(SteepFields, ErrorFallsAsModesAreAdded) {
  const double few = largestFarError(fit(8, 6)), more = largestFarError(fit(24, 6)),
               many = largestFarError(fit(72, 6));
  EXPECT_LT(more, 0.8 * few);
  EXPECT_LT(many, 0.5 * more);
}

TEST_F(SteepFields, SweepsImproveTheFit) {
  const FarField far = fit(24, 6);
  ASSERT_EQ(far.errors.size(), 7U);
  EXPECT_LT(far.errors.back(), 0.9 * far.errors.front());
  EXPECT_LE(far.errors.back(), far.errors[1] * 1.001);
}

TEST_F(SteepFields, FarErrorIsSmallerThanWhatPlainModesLeave) {
  const FarField masked = fit(24, 6);
  for (FitWeights& weights : weights_) weights = {};
  const FarField plain = fit(24, 6);
  EXPECT_LT(largestFarError(masked), 0.7 * largestFarError(plain));
}

TEST_F(SteepFields, ModesAreOrthonormalAndFallInEnergy) {
  const FarField far = fit(12, 4);
  double total = 0.0;
  for (const double area : surface_.areas) total += area;
  Eigen::MatrixXd weighted = far.X.cast<double>();
  for (Eigen::Index row = 0; row < weighted.rows(); ++row)
    weighted.row(row) *= surface_.areas[static_cast<std::size_t>(row / 3)] / total;
  const Eigen::MatrixXd gram = far.X.cast<double>().transpose() * weighted;
  EXPECT_LT((gram - Eigen::MatrixXd::Identity(12, 12)).cwiseAbs().maxCoeff(), 1e-4);
  for (int k = 1; k < 12; ++k) EXPECT_LE(far.Y.row(k).norm(), far.Y.row(k - 1).norm() * 1.001F);
}

TEST_F(SteepFields, DoesNotDependOnTheNumberOfWorkers) {
  EXPECT_NEAR(largestFarError(fit(24, 4, 1)), largestFarError(fit(24, 4, 2)), 1e-3);
}

TEST(NearWindow, FallsSmoothlyFromOneToZero) {
  EXPECT_EQ(nearWindow(0.0, 0.025), 1.0);
  EXPECT_EQ(nearWindow(0.025, 0.025), 0.0);
  double before = 1.0;
  for (double r = 0.0; r <= 0.026; r += 1e-5) {
    const double w = nearWindow(r, 0.025);
    EXPECT_LE(w, before);
    EXPECT_LT(before - w, 0.003);  // no step
    before = w;
  }
}

TEST(FieldTable, GivesBackWhatWasWritten) {
  FieldTable table(std::filesystem::temp_directory_path(), 5, 2, 3);
  for (std::size_t s = 0; s < 5; ++s) {
    const auto x = static_cast<float>(s);
    table.write(s, {x, 1, 2, 3, 4, x});
  }
  std::vector<float> fields;
  table.read(3, 2, fields);
  EXPECT_EQ(fields, (std::vector<float>{3, 1, 2, 3, 4, 3, 4, 1, 2, 3, 4, 4}));
}

TEST(FieldTable, SaysWhichFolderHasNoRoom) {
  try {
    const FieldTable table("/nowhere/at/all", 1, 1, 1);
    FAIL() << "a scratch file in a folder that is not there";
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("/nowhere/at/all"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace palpate::solver
