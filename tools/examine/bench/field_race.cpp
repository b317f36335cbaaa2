// SPDX-License-Identifier: Apache-2.0
#include "tools/examine/bench/field_race.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <random>

#include "core/base/multi_index.h"
#include "tools/examine/bench/eigen_product.h"
#include "tools/examine/bench/plain_read.h"
#include "tools/examine/bench/reference_field.h"
#include "tools/examine/bench/scratch_model.h"
#include "tools/examine/feel/surface_path.h"

namespace palpate::bench {

namespace {

constexpr int kWays = 4;
constexpr double kStep = 5e-5, kLength = 0.005;  // m: 50 mm/s at 1 kHz

/// Displacements up to 0.9 d_max in any direction.
Vec3 randomDisplacement(double domain, std::mt19937& random) {
  std::normal_distribution<double> gauss;
  std::uniform_real_distribution<double> size(0.2, 0.9);
  return size(random) * domain * Vec3(gauss(random), gauss(random), gauss(random)).normalized();
}

double largestNorm(std::span<const double> u) {
  double most = 0.0;
  for (std::size_t i = 0; i + 2 < u.size(); i += 3)
    most = std::max(most, std::hypot(u[i], u[i + 1], u[i + 2]));
  return most;
}

}  // namespace

FieldRace::FieldRace(const SyntheticSize& size)
    : data_(syntheticModel(size)),
      model_(throughFile(data_)),
      scratch_(model_),
      u_(3 * model_.view().surfaceNodes()) {
  ask();
}

void FieldRace::ask() {
  std::mt19937 random(1);
  for (int ways = 0; ways < kWays;) {
    const auto path = feel::randomPath(model_, 0.0, kStep, kLength, random);
    if (!path) continue;
    ++ways;
    for (const feel::PathPoint& point : *path) {
      const double domain = model_.response().limit(model_.surface().mix(point.s));
      Question question{{point.s, randomDisplacement(domain, random), 1.0}, {}};
      for (const double y : referenceAmplitudes(data_, model_, question.source))
        question.amplitudes.push_back(static_cast<float>(y));
      questions_.push_back(std::move(question));
    }
  }
}

void FieldRace::run(Runner who) {
  const Question& question = questions_[next_];
  next_ = (next_ + 1) % questions_.size();
  if (who == Runner::kPalpate) {
    evaluateField(model_, std::span(&question.source, 1), scratch_, u_);
    benchmark::DoNotOptimize(u_.data());
  } else if (who == Runner::kEigen) {
    eigenProduct(data_.modes_X, question.amplitudes, u_);
    benchmark::DoNotOptimize(u_.data());
  } else {
    benchmark::DoNotOptimize(plainRead(model_.view().modes_X.asBytes()));
  }
  benchmark::ClobberMemory();
}

void FieldRace::measure(double seconds) {
  constexpr double kBlock = 2000.0;  // us
  constexpr int kWarmUp = 2, kFewest = 4, kRounds = 6;
  std::array<int, kRunners.size()> evaluations{};
  for (const Runner who : kRunners) {
    Samples trial;
    for (int i = 0; i < 5; ++i) trial.time([&] { run(who); });
    evaluations[static_cast<std::size_t>(who)] =
        std::max(kFewest, static_cast<int>(kBlock / trial.quantile(0.5)));
  }
  const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
  for (int round = 0; round < kRounds || std::chrono::steady_clock::now() < end; ++round)
    for (const Runner who : kRunners) {
      const auto w = static_cast<std::size_t>(who);
      for (int i = 0; i < kWarmUp; ++i) run(who);
      for (int i = 0; i < evaluations[w]; ++i) samples_[w].time([&] { run(who); });
    }
  for (const Runner who : kRunners) errors_[static_cast<std::size_t>(who)] = worstError(who);
}

std::size_t FieldRace::bytes(Runner who) const {
  return who == Runner::kEigen ? data_.modes_X.size() * sizeof(float) : model_.view().modes_X.size_bytes();
}

double FieldRace::worstError(Runner who) {
  constexpr std::size_t kFields = 12;
  if (who == Runner::kPlainRead) return 0.0;
  double worst = 0.0;
  for (std::size_t i = 0; i < kFields; ++i) {
    next_ = i * questions_.size() / kFields;
    const Question& question = questions_[next_];
    const std::vector<double> truth = who == Runner::kPalpate ? referenceField(data_, model_, question.source)
                                                              : referenceModes(data_, question.amplitudes);
    run(who);
    std::vector<double> difference(truth.size());
    for (std::size_t k = 0; k < truth.size(); ++k) difference[k] = static_cast<double>(u_[k]) - truth[k];
    worst = std::max(worst, largestNorm(difference) / largestNorm(truth));
  }
  return worst;
}

}  // namespace palpate::bench
