// SPDX-License-Identifier: Apache-2.0
// What palpate-bench measures on, and what it holds the results against.
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <map>

#include "tools/examine/bench/cadence_bench.h"
#include "tools/examine/bench/eigen_product.h"
#include "tools/examine/bench/ellipsoid.h"
#include "tools/examine/bench/plain_read.h"
#include "tools/examine/bench/reference_field.h"
#include "tools/examine/bench/scratch_model.h"
#include "tools/examine/bench/step_bench.h"
#include "tools/examine/bench/synthetic_model.h"

namespace palpate::testing {

namespace {

using bench::syntheticModel;
using modelfile::ModelData;

constexpr bench::SyntheticSize kSmall{300, 25, 120};

/// Largest difference between what the loaded model shows and what the data say, over the largest displacement.
double errorOf(const ModelData& data, const MetaModel& model) {
  FieldScratch scratch(model);
  std::vector<float> u(data.surface_positions.size());
  const FieldSource source{model.surface().atNode(0), Vec3(0.001, -0.002, 0.003), 1.0};
  evaluateField(model, std::span(&source, 1), scratch, u);
  const std::vector<double> truth = bench::referenceField(data, model, source);
  double error = 0.0, largest = 0.0;
  for (std::size_t i = 0; i < u.size(); ++i) {
    error = std::max(error, std::abs(static_cast<double>(u[i]) - truth[i]));
    largest = std::max(largest, std::abs(truth[i]));
  }
  return error / largest;
}

}  // namespace

TEST(BenchEllipsoid, IsClosedAndHasAsManyNodesAsAskedFor) {
  for (const int nodes : {20, 21, 500, 2009, 20000}) {
    const bench::Ellipsoid surface = bench::ellipsoid(nodes, Vec3(0.03, 0.02, 0.01));
    EXPECT_EQ(surface.nodes.size(), static_cast<std::size_t>(nodes));
    EXPECT_EQ(surface.triangles.size(), 2 * static_cast<std::size_t>(nodes) - 4) << "Euler";
    std::map<std::pair<int, int>, int> edges;
    double volume = 0.0;
    for (const auto& t : surface.triangles) {
      for (std::size_t k = 0; k < 3; ++k) ++edges[{t[k], t[(k + 1) % 3]}];
      const auto X = [&](std::size_t k) { return surface.nodes[static_cast<std::size_t>(t[k])]; };
      volume += X(0).dot(X(1).cross(X(2))) / 6.0;
    }
    for (const auto& [edge, times] : edges) {
      EXPECT_EQ(times, 1);
      EXPECT_EQ(edges.count({edge.second, edge.first}), 1U);
    }
    const double whole = 4.0 / 3.0 * 3.14159265 * 6e-6;
    EXPECT_NEAR(volume / whole, 1.0, 40.0 / nodes) << "outward, and where the ellipsoid is";
  }
}

TEST(BenchModel, FieldOfTheLoadedModelIsThatOfTheData) {
  const ModelData data = syntheticModel(kSmall);
  const MetaModel model = bench::throughFile(data);
  const double error = errorOf(data, model);
  EXPECT_LT(error, 1e-4);
  EXPECT_GT(error, 0.0) << "whole numbers are rounded: an error of nothing was not measured";
}

TEST(BenchModel, FieldOfNodesThatShareTheirLoadsIsNotCompared) {
  ModelData data = syntheticModel(kSmall);
  const MetaModel model = bench::throughFile(data);
  data.green_node.clear();
  EXPECT_THROW((void)errorOf(data, model), std::invalid_argument);
}

TEST(BenchModel, ErrorShowsAModeThatIsOff) {
  ModelData data = syntheticModel(kSmall);
  const MetaModel model = bench::throughFile(data);
  for (std::size_t i = 0; i < data.surface_positions.size(); ++i) data.modes_X[i] *= 1.05F;
  EXPECT_GT(errorOf(data, model), 1e-3);
}

TEST(BenchModel, ErrorShowsANearFieldThatIsOff) {
  ModelData data = syntheticModel(kSmall);
  const MetaModel model = bench::throughFile(data);
  const ModelData good = data;
  for (float& u : data.green_near) u *= 1.05F;
  EXPECT_GT(errorOf(data, model), 1e-3);
  data = good;
  for (float& u : data.near_field) u *= 1.5F;
  EXPECT_GT(errorOf(data, model), 1e-3) << "orders of two and more";
}

TEST(BenchModel, ModesFallLikeMeasuredOnes) {
  const ModelData data = syntheticModel({300, 101, 120});
  const std::size_t modes = 101, rows = data.green_Y.size() / modes;
  const auto rms = [&](std::size_t k) {
    double sum = 0.0;
    for (std::size_t row = 0; row < rows; ++row)
      sum += std::pow(static_cast<double>(data.green_Y[row * modes + k]), 2);
    return std::sqrt(sum / static_cast<double>(rows));
  };
  EXPECT_NEAR(std::log10(rms(10) / rms(0)), std::log10(0.086 / 1.3), 0.35);
  EXPECT_NEAR(std::log10(rms(40) / rms(0)), std::log10(0.018 / 1.3), 0.35);
  EXPECT_NEAR(std::log10(rms(100) / rms(0)), std::log10(0.008 / 1.3), 0.35);
}

TEST(BenchStep, ToolsTouchTheOrganWhileTheyAreMeasured) {
  const MetaModel model = bench::throughFile(syntheticModel({600, 20, 400}));
  for (const int tools : {1, 2}) {
    const bench::StepTimes times = bench::timeSteps(model, tools, 3, 0.005);
    EXPECT_GT(times.in_contact, 0.8);
    EXPECT_GT(times.samples.count(), 300U);
    EXPECT_EQ(times.fields.count(), times.samples.count());
  }
}

TEST(BenchCadence, TicksOfAToolInContactComeAtTheRate) {
  const MetaModel model = bench::throughFile(syntheticModel({600, 20, 400}));
  const auto begin = std::chrono::steady_clock::now();
  const bench::StepTimes times = bench::timeAtCadence(model, {.rate_hz = 2000.0, .ways = 3, .length = 0.005});
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - begin;
  const double ticks = static_cast<double>(times.samples.count()) / times.in_contact;
  EXPECT_NEAR(ticks, 2.0 * 3.0 * (100.0 + 50.0), 10.0) << "each way at 50 mm/s";
  EXPECT_GE(seconds.count(), 0.99 * ticks / 2000.0) << "it waits for each";
  EXPECT_GT(times.in_contact, 0.8);
}

TEST(BenchEigen, ProductIsTheSumOfTheModes) {
  const std::vector<float> X{1, 2, 3, 4, 5, 6}, y{10, 100};
  std::vector<float> u(3, -1.0F);
  bench::eigenProduct(X, y, u);
  EXPECT_EQ(u, (std::vector<float>{410, 520, 630}));
}

TEST(BenchPlainRead, EveryByteCounts) {
  std::vector<std::byte> bytes(1000, std::byte{0});
  const std::uint64_t nothing = bench::plainRead(bytes);
  for (const std::size_t i : {0U, 255U, 256U, 511U, 767U, 768U, 999U}) {
    bytes[i] = std::byte{1};
    EXPECT_NE(bench::plainRead(bytes), nothing) << i;
    bytes[i] = std::byte{0};
  }
}

}  // namespace palpate::testing
