// SPDX-License-Identifier: Apache-2.0
#include "tools/solver/fit/far_field.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>

#include "../boxes.h"
#include "tools/solver/fit/normal_equations.h"

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
      sources_.push_back(
          {surface_.positions[s], fitWeights(surface_, surface_.positions[s], kRho), 1.0, 1.0});
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
    return fitFarField({table_, basis_, surface_.areas, surface_.positions, sources_, 1.0}, options);
  }

  /// 95 of 100 are not larger.
  static double quantile(std::vector<float> list) {
    std::sort(list.begin(), list.end());
    return double{list[list.size() - 1 - list.size() / 20]};
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
  FieldTable table_{std::filesystem::temp_directory_path(), surface_.positions.size(), 3,
                    3 * surface_.positions.size()};
  std::vector<FitSource> sources_;
};

TEST_F(SteepFields, ErrorFallsAsModesAreAdded) {
  const double few = largestFarError(fit(8, 6)), more = largestFarError(fit(24, 6)),
               many = largestFarError(fit(72, 6));
  EXPECT_LT(more, 0.8 * few);
  EXPECT_LT(many, 0.5 * more);
}

TEST_F(SteepFields, AmplitudesOfOtherSourcesAreLinearInTheirFields) {
  const FarField far = fit(24, 6);
  // Two sources at one place: fields that the modes hold exactly, and those of node 7 and 3 times these.
  const std::vector<FitSource> pair{sources_[7], sources_[7]};
  const Eigen::MatrixXf known = Eigen::MatrixXf::Random(far.X.cols(), 3), held = far.X * known;
  Eigen::MatrixXf own(far.X.rows(), 3);
  table_.read(7, {own.data(), static_cast<std::size_t>(own.size())});
  FieldTable table(std::filesystem::temp_directory_path(), 2, 3, 3 * surface_.positions.size());
  const auto amplitudes = [&](const Eigen::MatrixXf& first, const Eigen::MatrixXf& second) {
    table.write(0, {first.data(), static_cast<std::size_t>(first.size())});
    table.write(1, {second.data(), static_cast<std::size_t>(second.size())});
    return amplitudesOf({table, basis_, surface_.areas, surface_.positions, pair, 1.0}, far.X, 2);
  };
  const Eigen::MatrixXf Y = amplitudes(held, own), sum = amplitudes(held + 3.0F * own, own);
  EXPECT_LT((Y.leftCols(3) - known).norm(), 1e-3F * known.norm());
  EXPECT_LT((sum.leftCols(3) - Y.leftCols(3) - 3.0F * Y.rightCols(3)).norm(), 1e-4F * sum.norm());
  EXPECT_EQ((sum.rightCols(3) - Y.rightCols(3)).norm(), 0.0F);
}

TEST_F(SteepFields, SweepsImproveTheFit) {
  const FarField far = fit(24, 6);
  ASSERT_EQ(far.errors.size(), 7U);
  EXPECT_LT(far.errors.back(), 0.9 * far.errors.front());
  EXPECT_LE(far.errors.back(), far.errors[1] * 1.001);
}

TEST_F(SteepFields, MovedWeightsLowerTheLargestError) {
  FitOptions options;
  options.modes = 24;
  options.sweeps = 4;
  options.quiet = true;
  const FitProblem problem{table_, basis_, surface_.areas, surface_.positions, sources_, 1.0};
  const FarField plain = fitFarField(problem, options);
  options.reweighted = 2;
  const FarField moved = fitFarField(problem, options);
  EXPECT_LT(quantile(moved.largest), 0.95 * quantile(plain.largest));
}

/// The reported errors are those of the modes, over all directions that were sampled.
TEST_F(SteepFields, ReportsTheLargestErrorThatIsSeen) {
  const FarField far = fit(24, 3);
  const Eigen::Vector3d d = Eigen::Vector3d(1.0, -1.0, 1.0).normalized();
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t s = 0; s < sources_.size(); ++s) {
    std::vector<float> fields(table_.rows() * 3);
    table_.read(s, fields);
    const Eigen::Map<const Eigen::MatrixXf> A(fields.data(), far.X.rows(), 3);
    const Eigen::MatrixXf rest = A - far.X * far.Y.middleCols(static_cast<Eigen::Index>(s) * 3, 3);
    const Eigen::VectorXd u =
        rest.cast<double>() * d.reverse();  // monomials of degree 1 as the basis has them
    double largest = 0.0;
    for (std::size_t i = 0; i < surface_.positions.size(); ++i)
      largest =
          std::max(largest, (1.0 - nearWindow((surface_.positions[i] - sources_[s].place).norm(), kRho)) *
                                u.segment<3>(static_cast<Eigen::Index>(3 * i)).norm());
    EXPECT_LE(largest, 1.0001 * double{far.largest[s]} + 1e-6);
    least = std::min(least, largest / double{far.largest[s]});
  }
  EXPECT_GT(least, 0.02);
}

TEST_F(SteepFields, AsManyModesAsTheAskedErrorWants) {
  FitOptions options;
  options.modes = 10;
  options.sweeps = 3;
  options.head_start = 2;
  options.reweighted = 1;
  options.quiet = true;
  const FitProblem problem{table_, basis_, surface_.areas, surface_.positions, sources_, 1.0};
  for (const double asked : {0.05, 0.02}) {
    options.error = asked;
    const FarField far = fitFarField(problem, options);
    EXPECT_LE(quantile(far.largest), asked);
    EXPECT_GT(far.X.cols(), 10);
    EXPECT_LT(far.X.cols(), options.most_modes);
  }
  options.error = 1e-9;
  options.most_modes = 40;
  EXPECT_EQ(fitFarField(problem, options).X.cols(), 40);
}

TEST_F(SteepFields, FarErrorIsSmallerThanWhatPlainModesLeave) {
  const FarField masked = fit(24, 6);
  for (FitSource& source : sources_) source.weights = {};
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
  const FarField one = fit(24, 4, 1);
  for (const int workers : {2, 3}) {
    const FarField other = fit(24, 4, workers);
    EXPECT_EQ((one.X - other.X).cwiseAbs().maxCoeff(), 0.0F) << workers;
    EXPECT_EQ((one.Y - other.Y).cwiseAbs().maxCoeff(), 0.0F) << workers;
    EXPECT_EQ(one.errors, other.errors) << workers;
  }
}

/// X^T diag(weight) (A - X Y) = 0 for every source, formed in double from the fields themselves.
TEST_F(SteepFields, YSolvesTheWeightedNormalEquations) {
  const FarField far = fit(24, 2);
  const Eigen::MatrixXd X = far.X.cast<double>();
  for (std::size_t s = 0; s < sources_.size(); ++s) {
    Eigen::VectorXd weight = Eigen::VectorXd::Ones(X.rows());
    const FitWeights& weights = sources_[s].weights;
    for (std::size_t j = 0; j < weights.nodes.size(); ++j)
      weight.segment<3>(3 * weights.nodes[j]).array() += double{weights.change[j]};
    for (Eigen::Index row = 0; row < X.rows(); ++row)
      weight[row] *= surface_.areas[static_cast<std::size_t>(row / 3)];
    std::vector<float> fields(static_cast<std::size_t>(X.rows()) * 3);
    table_.read(s, fields);
    const Eigen::MatrixXd A = Eigen::Map<const Eigen::MatrixXf>(fields.data(), X.rows(), 3).cast<double>();
    const Eigen::MatrixXd Y = far.Y.middleCols(static_cast<Eigen::Index>(s) * 3, 3).cast<double>();
    const Eigen::MatrixXd b = X.transpose() * weight.asDiagonal() * A;
    EXPECT_LT((X.transpose() * weight.asDiagonal() * (X * Y) - b).norm(), 1e-5 * b.norm());
  }
}

TEST_F(SteepFields, NamesTheSourceWhoseFieldsAreNotFinite) {
  std::vector<float> fields(surface_.positions.size() * 9);
  fields[5] = std::numeric_limits<float>::quiet_NaN();
  table_.write(3, fields);
  try {
    (void)fit(8, 2);
    FAIL() << "modes of fields that are not finite";
  } catch (const FitError& error) {
    EXPECT_NE(std::string(error.what()).find("source 3 are not finite"), std::string::npos) << error.what();
  }
}

TEST_F(SteepFields, NodesInsideEveryNearFieldAreNoFailure) {
  for (FitSource& source : sources_) source.weights = fitWeights(surface_, source.place, 1.0);
  EXPECT_TRUE(fit(8, 3).X.allFinite());
}

/// The same organ at a fifth of the size, and in millimetres.
TEST_F(SteepFields, DoesNotDependOnTheUnitOfLength) {
  const FarField far = fit(24, 4);
  for (const double size : {0.2, 1000.0}) {
    const auto scale = static_cast<float>(size);
    FieldTable table(std::filesystem::temp_directory_path(), sources_.size(), 3, table_.rows());
    std::vector<float> fields(table_.rows() * 3);
    std::vector<FitSource> sources = sources_;
    for (std::size_t s = 0; s < sources.size(); ++s) {
      table_.read(s, fields);
      table.write(s, fields);  // of degree 1, displacement by displacement: no unit
      sources[s].ball_radius *= size;
      sources[s].size *= size;
    }
    std::vector<Vec3> places = surface_.positions;
    for (Vec3& place : places) place *= size;
    std::vector<double> areas = surface_.areas;
    for (double& area : areas) area *= size * size;
    FitOptions options;
    options.modes = 24;
    options.sweeps = 4;
    options.quiet = true;
    const FarField other = fitFarField({table, basis_, areas, places, sources, size}, options);
    EXPECT_NEAR(other.errors.back(), far.errors.back(), 1e-3 * far.errors.back());
    const Eigen::MatrixXf u = far.X * far.Y, v = other.X * other.Y;
    EXPECT_LT((u * scale - v).norm(), 1e-3F * v.norm());
  }
}

/// Fields as a load on a patch makes them: polynomials of d with nineteen coefficients, that act on the rest by a few moments.
class PatchFields : public SteepFields {
 protected:
  static constexpr int kMoments = 9;

  PatchFields() {
    Eigen::MatrixXf bases(static_cast<Eigen::Index>(cubic_.rows()), kMoments);
    for (std::size_t s = 0; s < sources_.size(); ++s) {
      for (Eigen::Index row = 0; row < bases.rows(); ++row)
        for (int m = 0; m < kMoments; ++m) {
          const Vec3 X = surface_.positions[static_cast<std::size_t>(row / 3)], at = sources_[s].place;
          const double r = (X - at + 0.002 * Vec3(m / 3 - 1, m % 3 - 1, 0)).norm();
          bases(row, m) = static_cast<float>(std::exp(-r / 0.02) * (row % 3 == m % 3 ? 1.0 : 0.2));
        }
      std::srand(static_cast<unsigned>(s));
      const Eigen::MatrixXf fields = bases * Eigen::MatrixXf::Random(kMoments, kCubic.size());
      cubic_.write(s, {fields.data(), static_cast<std::size_t>(fields.size())});
    }
  }

  [[nodiscard]] FarField fitCubic(const std::filesystem::path& scratch) const {
    FitOptions options;
    options.modes = 30;
    options.sweeps = 3;
    options.reweighted = 1;
    options.scratch = scratch;
    options.workers = 2;
    options.quiet = true;
    return fitFarField({cubic_, kCubic, surface_.areas, surface_.positions, sources_, 1.0}, options);
  }

  inline static const MonomialBasis kCubic{3};
  FieldTable cubic_{std::filesystem::temp_directory_path(), surface_.positions.size(),
                    static_cast<std::size_t>(kCubic.size()), 3 * surface_.positions.size()};
};

TEST_F(PatchFields, SweepsOverPrincipalFieldsEndAsSweepsOverAll) {
  const FarField all = fitCubic({}), few = fitCubic(std::filesystem::temp_directory_path());
  ASSERT_EQ(few.Y.cols(), all.Y.cols());
  EXPECT_NEAR(few.errors.back(), all.errors.back(), 0.02 * all.errors.back());
  EXPECT_NEAR(quantile(few.largest), quantile(all.largest), 0.1 * quantile(all.largest));
  const Eigen::MatrixXf u = all.X * all.Y, v = few.X * few.Y;
  EXPECT_LT(double{(u - v).norm()}, 2.0 * all.errors.back() * double{u.norm()});
}

TEST_F(PatchFields, NamesTheSourceBeforeItLooksForPrincipalFields) {
  std::vector<float> fields(cubic_.rows() * static_cast<std::size_t>(kCubic.size()));
  fields[5] = std::numeric_limits<float>::infinity();
  cubic_.write(3, fields);
  EXPECT_THROW(
      {
        try {
          (void)fitCubic(std::filesystem::temp_directory_path());
        } catch (const FitError& error) {
          EXPECT_STREQ(error.what(), "the fields of source 3 are not finite");
          throw;
        }
      },
      FitError);
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
    table.write(s, std::vector<float>{x, 1, 2, 3, 4, x});
  }
  std::vector<float> fields(6);
  table.read(3, fields);
  EXPECT_EQ(fields, (std::vector<float>{3, 1, 2, 3, 4, 3}));
}

TEST(FieldTable, SaysWhichFolderHasNoRoom) {
  try {
    const FieldTable table(std::filesystem::path("/nowhere/at/all"), 1, 1, 1);
    FAIL() << "a scratch file in a folder that is not there";
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("/nowhere/at/all"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace palpate::solver
