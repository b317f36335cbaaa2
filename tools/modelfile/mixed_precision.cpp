// SPDX-License-Identifier: Apache-2.0
#include "tools/modelfile/mixed_precision.h"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <random>
#include <utility>

#include "core/base/multi_index.h"
#include "core/data/parameter_functions.h"
#include "tools/modelfile/pack_modes.h"

namespace palpate::modelfile {

namespace {

using Rows = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
using Eigen::Index;

/// Amplitudes of the modes in fields of random contacts, and how large each field is.
struct Samples {
  Eigen::MatrixXf y;           ///< [n][samples], over the largest displacement of the field
  std::vector<float> typical;  ///< [n] RMS over the samples
};

float largestNode(const Eigen::VectorXf& u) {
  const Eigen::Map<const Eigen::Matrix3Xf> nodes(u.data(), 3, u.size() / 3);
  return std::sqrt(nodes.colwise().squaredNorm().maxCoeff());
}

/// A parameter within the domain of a position: half of them on its border, where high orders count most.
Vec3 randomParameter(const ModelData& data, std::size_t position, std::mt19937& random) {
  std::uniform_real_distribution<double> share(0.05, 2.0);
  std::normal_distribution<double> normal;
  const double size = data.contact_domain_radius[position] * std::min(1.0, share(random));
  if (data.attributes.parameters == Parameters::kLevel) return {size, 0.0, 0.0};
  const Vec3 way(normal(random), normal(random), normal(random));
  return size * way.normalized();
}

Samples sample(const ModelData& data, const Rows& X) {
  constexpr int kSamples = 128;
  ModelView view;
  view.levels_Z = data.levels_Z;
  view.level_functions =
      data.levels_Z.empty() ? 0 : data.contact_displacement.size() / (3 * data.contact_node.size());
  const ParameterFunctions functions(view, data.attributes, data.attributes.order);
  std::vector<double> phi(static_cast<std::size_t>(functions.size()));
  std::mt19937 random(1);
  std::uniform_int_distribution<std::size_t> anywhere(0, data.contact_node.size() - 1);
  Samples samples{Eigen::MatrixXf::Zero(X.rows(), kSamples), {}};
  for (Index s = 0; s < kSamples; ++s) {
    const std::size_t m = anywhere(random);
    functions.evaluate(randomParameter(data, m, random), phi);
    const Eigen::Map<const Rows> Y(data.modes_Y.data() + m * phi.size() * static_cast<std::size_t>(X.rows()),
                                   static_cast<Index>(phi.size()), X.rows());
    const Eigen::VectorXf y =
        Y.transpose() * Eigen::Map<const Eigen::VectorXd>(phi.data(), Y.rows()).cast<float>();
    const float size = largestNode(X.transpose() * y);
    if (size > 0.0F) samples.y.col(s) = y / size;
  }
  for (Index k = 0; k < X.rows(); ++k)
    samples.typical.push_back(samples.y.row(k).norm() / std::sqrt(static_cast<float>(kSamples)));
  return samples;
}

using Kinds = std::vector<ModePrecision>;

/// What a kind costs, and its largest rounding error over the largest number of a mode.
struct Cost {
  ModePrecision kind;
  double bits;
  double rounding;
};
constexpr std::array kCosts{
    Cost{ModePrecision::kFloat32, 32.0, 0.0}, Cost{ModePrecision::kInt16, 16.0, 0.5 / 32767.0},
    Cost{ModePrecision::kBits10, 10.0, 0.5 / 4.0 / 115.0}, Cost{ModePrecision::kBits8, 8.0, 0.5 / 127.0}};

/// The kind of each mode that costs least when a squared rounding error of `price` costs a bit.
/// @param size  of each mode's largest number in a typical field
Kinds chooseKinds(std::span<const float> size, double price) {
  Kinds kinds;
  for (const float s : size) {
    const auto cost = [&](const Cost& c) {
      const double error = c.rounding * static_cast<double>(s);
      return c.bits + error * error / price;
    };
    kinds.push_back(std::min_element(kCosts.begin(), kCosts.end(), [&](const Cost& a, const Cost& b) {
                      return cost(a) < cost(b);
                    })->kind);
  }
  return kinds;
}

ModeCounts count(const Kinds& kinds) {
  const auto of = [&](ModePrecision kind) {
    return static_cast<std::size_t>(std::count(kinds.begin(), kinds.end(), kind));
  };
  return {of(ModePrecision::kFloat32), of(ModePrecision::kInt16), of(ModePrecision::kBits10),
          of(ModePrecision::kBits8)};
}

/// Modes by kind, those of a kind by size: what shares a quad is seen together.
std::vector<Index> orderOf(const Kinds& kinds, std::span<const float> size) {
  std::vector<Index> order(kinds.size());
  std::iota(order.begin(), order.end(), Index{0});
  const auto rank = [&](Index k) {
    const auto place = static_cast<std::size_t>(k);
    return std::pair(kinds[place], -size[place]);
  };
  std::stable_sort(order.begin(), order.end(), [&](Index a, Index b) { return rank(a) < rank(b); });
  return order;
}

/// What the stored modes would be.
struct Storage {
  std::vector<Index> order;
  ModeCounts counts;
  PackedModesData packed;
  double error{0.0};
};

std::size_t bytesOf(const Storage& storage, Index numbers) {
  return sizeof(float) * storage.counts.f32 * static_cast<std::size_t>(numbers) +
         sizeof(std::int16_t) * storage.packed.X16.size() + storage.packed.X8.size();
}

Storage store(const Rows& X, const Samples& samples, std::span<const float> size, const Kinds& kinds) {
  Storage storage{orderOf(kinds, size), count(kinds), {}, 0.0};
  const Rows ordered = X(storage.order, Eigen::all);
  const std::size_t numbers = static_cast<std::size_t>(X.cols());
  storage.packed =
      packModes({ordered.data(), static_cast<std::size_t>(ordered.size())}, numbers, storage.counts);
  const PackedModes packed = storage.packed.view();
  Rows error = Rows::Zero(X.rows(), X.cols());
  for (Index k = static_cast<Index>(storage.counts.f32); k < X.rows(); ++k)
    for (Index i = 0; i < X.cols(); ++i)
      error(k, i) = unpack(packed, storage.counts, static_cast<std::size_t>(k), static_cast<std::size_t>(i)) -
                    ordered(k, i);
  const Eigen::MatrixXf y = samples.y(storage.order, Eigen::all);
  for (Index s = 0; s < y.cols(); ++s)
    storage.error = std::max(storage.error, double(largestNode(error.transpose() * y.col(s))));
  return storage;
}

/// The fewest bytes that keep the limit: the price of a bit is found by trial, as errors go with its root.
Storage search(const Rows& X, const Samples& samples, double limit) {
  constexpr int kTrials = 8;
  std::vector<float> size;
  for (Index k = 0; k < X.rows(); ++k)
    size.push_back(samples.typical[static_cast<std::size_t>(k)] * X.row(k).cwiseAbs().maxCoeff());
  Storage best = store(X, samples, size, Kinds(size.size(), ModePrecision::kFloat32));
  double price = limit * limit / 500.0;
  for (int trial = 0; trial < kTrials; ++trial) {
    Storage storage = store(X, samples, size, chooseKinds(size, price));
    const double share = 0.97 * limit / std::max(storage.error, 1e-3 * limit);
    if (storage.error <= limit && bytesOf(storage, X.cols()) < bytesOf(best, X.cols()))
      best = std::move(storage);
    price *= share * share;
  }
  return best;
}

void reorder(const Storage& storage, const Rows& X, ModelData& data) {
  const Rows ordered = X(storage.order, Eigen::all);
  std::copy_n(ordered.data(), ordered.size(), data.modes_X.begin());
  const Index columns = static_cast<Index>(data.modes_Y.size()) / X.rows();
  Eigen::Map<Rows> Y(data.modes_Y.data(), columns, X.rows());
  for (Index row = 0; row < columns; ++row) {
    const Eigen::RowVectorXf before = Y.row(row);
    Y.row(row) = before(storage.order);
  }
}

}  // namespace

StorageReport storeMixed(ModelData& data, double own_error) {
  StorageReport report;
  const std::size_t n = modeCount(data);
  report.counts.f32 = n;
  report.bytes = sizeof(float) * data.modes_X.size();
  report.error_limit = std::min(0.1 * own_error, kMostRounding);
  if (n == 0 || !(report.error_limit > 0.0)) return report;
  const Rows X = Eigen::Map<const Rows>(data.modes_X.data(), static_cast<Index>(n),
                                        static_cast<Index>(data.modes_X.size() / n));
  Storage storage = search(X, sample(data, X), report.error_limit);
  if (storage.packed.view().empty()) return report;
  reorder(storage, X, data);
  report.bytes = bytesOf(storage, X.cols());
  data.modes_packed = std::move(storage.packed);
  report.counts = storage.counts;
  report.error_max = storage.error;
  return report;
}

}  // namespace palpate::modelfile
