// SPDX-License-Identifier: Apache-2.0
#include "palpate/modelfile/mixed_precision.h"

#include <gtest/gtest.h>
#include <hwy/targets.h>

#include <cmath>
#include <limits>
#include <numeric>
#include <random>

#include "palpate/core/fields.h"
#include "palpate/core/packed_modes.h"

namespace palpate::testing {

namespace {

/// Random modes of mixed sizes, packed, and the view that a field reads.
class PackedField {
 public:
  PackedField(std::size_t nodes, const ModeCounts& counts) : counts_(counts), X_(3 * nodes * modes()) {
    std::mt19937 random(7);
    std::uniform_real_distribution<float> number(-1.0F, 1.0F);
    for (std::size_t k = 0; k < modes(); ++k) {
      const float size = std::ldexp(1.0F, static_cast<int>(k % 9) - 4);
      for (std::size_t i = 0; i < 3 * nodes; ++i) X_[k * 3 * nodes + i] = size * number(random);
    }
    packed_ = modelfile::packModes(X_, 3 * nodes, counts);
    tags_.resize(nodes);
  }

  [[nodiscard]] std::size_t modes() const { return counts_.f32 + counts_.i16 + counts_.i8; }
  [[nodiscard]] std::size_t numbers() const { return 3 * tags_.size(); }
  [[nodiscard]] float x(std::size_t mode, std::size_t i) const { return X_[mode * numbers() + i]; }
  [[nodiscard]] PackedModes packed() const { return packed_.view(); }
  [[nodiscard]] float stored(std::size_t mode, std::size_t i) const {
    return mode < counts_.f32 ? x(mode, i) : unpack(packed(), counts_, mode, i);
  }
  [[nodiscard]] ModelView view() const {
    ModelView view;
    view.surface_mesh_tag = tags_;
    view.modes_X = X_;
    view.modes_packed = packed_.view();
    return view;
  }

 private:
  ModeCounts counts_;
  std::vector<float> X_;
  std::vector<std::int64_t> tags_;
  modelfile::PackedModesData packed_;
};

/// Falling like the modes of a model.
std::vector<float> amplitudes(std::size_t modes) {
  std::vector<float> y(modes);
  for (std::size_t k = 0; k < modes; ++k)
    y[k] = 0.003F * std::pow(0.85F, static_cast<float>(k)) * (k % 3 == 1 ? -1.0F : 1.0F);
  return y;
}

std::vector<float> expanded(const SeparatedField& field, std::span<const float> y, float unseen,
                            std::size_t numbers) {
  ModeSelection selection(field.counts());
  std::vector<float> u(numbers, 0.0F);
  field.expand(y, unseen, selection, u);
  return u;
}

/// Every instruction set that this processor has, then all again.
class Targets {
 public:
  Targets() {
    std::int64_t all = hwy::SupportedTargets();
    for (; all != 0; all &= all - 1) list_.push_back(all & -all);
  }
  Targets(const Targets&) = delete;
  Targets& operator=(const Targets&) = delete;
  ~Targets() {
    hwy::SetSupportedTargetsForTest(0);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
  }
  [[nodiscard]] const std::vector<std::int64_t>& list() const { return list_; }

 private:
  std::vector<std::int64_t> list_;
};

}  // namespace

TEST(PackedModes, NumbersStayWithinHalfAStep) {
  const ModeCounts counts{1, 3, 7};
  const PackedField field(71, counts);
  for (std::size_t mode = counts.f32; mode < field.modes(); ++mode)
    for (std::size_t i = 0; i < field.numbers(); ++i) {
      ASSERT_LE(std::abs(field.stored(mode, i) - field.x(mode, i)),
                0.51F * scaleOf(field.packed(), counts, mode))
          << mode << ' ' << i;
    }
}

TEST(SeparatedField, EveryInstructionSetAddsWhatIsStored) {
  const Targets targets;
  ASSERT_FALSE(targets.list().empty());
  for (const ModeCounts& counts : {ModeCounts{2, 5, 11}, {0, 8, 0}, {0, 0, 9}, {3, 0, 4}, {4, 0, 0}}) {
    const PackedField packed(71, counts);  // 213 numbers: three tiles and a part of one
    const std::vector<float> y = amplitudes(packed.modes());
    for (const std::int64_t target : targets.list()) {
      hwy::SetSupportedTargetsForTest(target);
      const SeparatedField field(packed.view());
      const std::vector<float> u = expanded(field, y, 0.0F, packed.numbers());
      for (std::size_t i = 0; i < u.size(); ++i) {
        double expected = 0.0, size = 0.0;
        for (std::size_t k = 0; k < y.size(); ++k) {
          expected += double(y[k]) * double(packed.stored(k, i));
          size += std::abs(double(y[k])) * 8.0;
        }
        ASSERT_NEAR(double(u[i]), expected, 4e-5 * size) << hwy::TargetName(target) << ' ' << i;
      }
    }
  }
}

// All numbers and weights of one sign and as large as they get: sums of 32 bits must hold them.
TEST(SeparatedField, TheLargestSumsFit) {
  const Targets targets;
  for (const std::size_t n : {1U, 2U, 3U, 333U}) {
    const ModeCounts counts{0, n, n};
    const std::size_t numbers = 3 * 70, tiles = tilesOf(numbers);
    const std::vector<std::int16_t> X16(tiles * counts.pairs() * kTile * 2,
                                        std::numeric_limits<std::int16_t>::min());
    const std::vector<std::int8_t> X8(tiles * counts.quads() * kTile * 4,
                                      std::numeric_limits<std::int8_t>::min());
    const std::vector<float> scale16(n, 1.0F / 32768.0F), scale8(n, 1.0F / 128.0F);
    const std::vector<std::int64_t> tags(70);
    const std::vector<float> X(2 * n * numbers, -1.0F), y(2 * n, 0.5F);
    ModelView view;
    view.surface_mesh_tag = tags;
    view.modes_X = X;
    view.modes_packed = {X16, X8, scale16, scale8};
    for (const std::int64_t target : targets.list()) {
      hwy::SetSupportedTargetsForTest(target);
      const SeparatedField field(view);
      const double size = static_cast<double>(n);  // b and d of a quad are smaller by half a step, 1 in 256
      for (const float u : expanded(field, y, 0.0F, numbers))
        ASSERT_NEAR(double(u), -size, 4e-3 * size) << hwy::TargetName(target) << ' ' << n;
    }
  }
}

TEST(SeparatedField, WhatIsLeftOutMovesNoNodeByMoreThanIsUnseen) {
  const PackedField packed(100, {0, 12, 60});
  const SeparatedField field(packed.view());
  const std::vector<float> y = amplitudes(packed.modes());
  const std::vector<float> all = expanded(field, y, 0.0F, packed.numbers());
  for (const float unseen : {1e-8F, 1e-6F, 1e-4F, 1.0F}) {
    const std::vector<float> some = expanded(field, y, unseen, packed.numbers());
    float largest = 0.0F;
    for (std::size_t i = 0; i < all.size(); i += 3)
      largest =
          std::max(largest, std::hypot(all[i] - some[i], all[i + 1] - some[i + 1], all[i + 2] - some[i + 2]));
    EXPECT_LE(largest, 1.01F * unseen);
    if (unseen == 1.0F) {
      EXPECT_GT(largest, 1e-3F) << "nothing was left out";
    }
  }
}

TEST(ModeSelection, LeavesOutAsMuchAsItMay) {
  const ModeCounts counts{0, 0, 64};
  ModeSelection selection(counts);
  std::vector<float> y(64, 1e-6F), peak(64, 1.0F), scale(64, 0.01F);
  const PackedModes packed{{}, {}, {}, scale};
  for (std::size_t k = 0; k < 8; ++k) y[k] = 1e-3F;
  selection.choose(y, peak, packed, 0.0F);
  EXPECT_EQ(selection.quads8().size(), 16U);
  selection.choose(y, peak, packed, 1e-4F);
  EXPECT_EQ(selection.quads8().size(), 2U);  // 56 of 1e-6 m fit into 1e-4 m
  selection.choose(y, peak, packed, 5e-5F);
  EXPECT_EQ(selection.quads8().size(), 16U);  // but not into half of that
}

TEST(ModeSelection, WholeWeightsFitTheirSum) {
  const std::size_t n = 333;
  ModeSelection selection({0, 0, n});
  std::vector<float> peak(n, 1.0F), scale(n, 1.0F);
  const PackedModes packed{{}, {}, {}, scale};
  for (const float fall : {1.0F, 0.9F, 0.1F}) {
    std::vector<float> y(n);
    for (std::size_t k = 0; k < n; ++k)
      y[k] = std::pow(fall, static_cast<float>(k)) * (k % 2 == 0 ? 1.0F : -1.0F);
    selection.choose(y, peak, packed, 0.0F);
    long sum = 0;
    for (std::size_t q = 0; q < selection.quads8().size(); ++q) {
      const QuadWeights& w = selection.weights8()[q];
      sum += std::abs(w.ac[0]) + std::abs(w.ac[1]) + std::abs(w.bd[0]) + std::abs(w.bd[1]);
    }
    EXPECT_LE(sum, 65535);
    EXPECT_GT(sum, 30000);
  }
}

TEST(SeparatedField, AmplitudesThatAreNoNumbersShow) {
  for (const ModeCounts& counts : {ModeCounts{0, 4, 0}, {0, 0, 4}}) {
    const PackedField packed(20, counts);
    const SeparatedField field(packed.view());
    for (const float wrong :
         {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
      const std::vector<float> y(4, wrong);
      const std::vector<float> u = expanded(field, y, 1e-6F, packed.numbers());
      EXPECT_TRUE(std::any_of(u.begin(), u.end(), [](float x) { return !std::isfinite(x); })) << wrong;
    }
  }
}

}  // namespace palpate::testing
