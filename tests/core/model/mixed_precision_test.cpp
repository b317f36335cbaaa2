// SPDX-License-Identifier: Apache-2.0
#include "tools/modelfile/mixed_precision.h"

#include <gtest/gtest.h>
#include <hwy/targets.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>

#include "../instruction_sets.h"
#include "core/data/packed_modes.h"
#include "core/model/fields.h"
#include "tools/modelfile/pack_modes.h"

namespace palpate::testing {

namespace {

/// Random modes of mixed sizes, packed, and the view that a field reads.
class PackedField {
 public:
  /// @param still  numbers at the end that are zero
  PackedField(std::size_t nodes, const ModeCounts& counts, std::size_t still = 0)
      : counts_(counts), X_(3 * nodes * modes()) {
    std::mt19937 random(7);
    std::uniform_real_distribution<float> number(-1.0F, 1.0F);
    for (std::size_t k = 0; k < modes(); ++k) {
      const float size = std::ldexp(1.0F, static_cast<int>(k % 9) - 4);
      for (std::size_t i = 0; i + still < 3 * nodes; ++i) X_[k * 3 * nodes + i] = size * number(random);
    }
    packed_ = modelfile::packModes(X_, 3 * nodes, counts);
    tags_.resize(nodes);
  }

  [[nodiscard]] std::size_t modes() const { return counts_.all(); }
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
  std::vector<float> u(numbers, 7.0F);  // written over
  field.expand(y, unseen, selection, u);
  return u;
}

}  // namespace

/// One kind, several, all; whole groups that share a byte and parts of one.
const std::vector<ModeCounts> kMixtures{{2, 5, 8, 11}, {0, 8, 0, 0}, {0, 0, 0, 9}, {3, 0, 3, 4},
                                        {4, 0, 0, 0},  {0, 0, 5, 0}, {0, 1, 7, 0}, {0, 0, 1, 1}};

TEST(PackedModes, NumbersStayWithinTheirRounding) {
  for (const ModeCounts& counts : kMixtures) {
    const PackedField field(71, counts);
    for (std::size_t mode = counts.f32; mode < field.modes(); ++mode)
      for (std::size_t i = 0; i < field.numbers(); ++i) {
        ASSERT_LE(std::abs(field.stored(mode, i) - field.x(mode, i)),
                  1.02F * roundingOf(field.packed(), counts, mode))
            << mode << ' ' << i;
      }
  }
}

// Clamped nodes at the end of the surface.
TEST(PackedModes, NoTileIsStoredForWhatDoesNotMove) {
  const InstructionSets targets;
  const ModeCounts counts{0, 3, 5, 2};
  for (const std::size_t still : {3U, 22U, 90U, 213U}) {
    const PackedField packed(71, counts, still);
    const std::size_t moving = packed.numbers() - still;
    EXPECT_EQ(packed.packed().tiles, tilesOf(moving));
    for (std::size_t i = moving; i < packed.numbers(); ++i) EXPECT_EQ(packed.stored(4, i), 0.0F);
    for (const std::int64_t target : targets.list()) {
      hwy::SetSupportedTargetsForTest(target);
      const SeparatedField field(packed.view());
      const std::vector<float> u = expanded(field, amplitudes(packed.modes()), 0.0F, packed.numbers());
      for (std::size_t i = moving; i < u.size(); ++i) ASSERT_EQ(u[i], 0.0F) << hwy::TargetName(target);
      if (moving > 0) {
        EXPECT_NE(u[moving - 1], 0.0F);
      }
    }
  }
}

TEST(PackedModes, RoundingFallsWithEveryBit) {
  const ModeCounts counts{0, 1, 4, 1};
  const PackedField field(200, counts);
  const auto share = [&](std::size_t mode) {  // of the largest number
    float most = 0.0F, error = 0.0F;
    for (std::size_t i = 0; i < field.numbers(); ++i) {
      most = std::max(most, std::abs(field.x(mode, i)));
      error = std::max(error, std::abs(field.stored(mode, i) - field.x(mode, i)));
    }
    return error / most;
  };
  EXPECT_LT(share(0), 1.1F / 65534.0F);
  for (const std::size_t mode : {1U, 2U, 3U, 4U}) EXPECT_LT(share(mode), 1.0F / 750.0F);  // 10 bits: 1024
  EXPECT_LT(share(5), 1.0F / 250.0F);
  EXPECT_GT(share(5), 1.0F / 300.0F) << "half a step of 254 is seen somewhere";
}

TEST(SeparatedField, EveryInstructionSetAddsWhatIsStored) {
  const InstructionSets targets;
  ASSERT_FALSE(targets.list().empty());
  for (const ModeCounts& counts : kMixtures) {
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
  const InstructionSets targets;
  for (const std::size_t n : {1U, 2U, 3U, 333U}) {
    const ModeCounts counts{0, n, 0, n};
    const std::size_t numbers = 3 * 70, tiles = tilesOf(numbers);
    const std::vector<std::int16_t> X16(tiles * counts.pairs() * kTile * 2,
                                        std::numeric_limits<std::int16_t>::min());
    const std::vector<std::uint8_t> X8(tiles * counts.quads() * kTile * 4, 0);  // 128 below what is none
    std::vector<float> scale(n, 1.0F / 32768.0F);
    scale.resize(2 * n, 1.0F / 128.0F);
    const std::vector<std::int32_t> kinds{static_cast<std::int32_t>(n), 0, static_cast<std::int32_t>(n)};
    const std::vector<std::int64_t> tags(70);
    const std::vector<float> X(2 * n * numbers, -1.0F), y(2 * n, 0.5F);
    ModelView view;
    view.surface_mesh_tag = tags;
    view.modes_X = X;
    view.modes_packed = {X16, X8, scale, kinds, tiles};
    for (const std::int64_t target : targets.list()) {
      hwy::SetSupportedTargetsForTest(target);
      const SeparatedField field(view);
      const double size = static_cast<double>(n);
      for (const float u : expanded(field, y, 0.0F, numbers))
        ASSERT_NEAR(double(u), -size, 4e-3 * size) << hwy::TargetName(target) << ' ' << n;
    }
  }
}

// The largest byte, 255, with the largest two weights: 32640 of 32767.
TEST(SeparatedField, TwoBytesAndTheirWeightsFitSixteenBits) {
  const InstructionSets targets;
  const std::size_t numbers = 3 * 70;
  const std::vector<std::uint8_t> X8(tilesOf(numbers) * kTile * 4, 255);
  const std::vector<float> scale(2, 1.0F), X(2 * numbers, 127.0F);
  const std::vector<std::int32_t> kinds{0, 0, 2};
  const std::vector<std::int64_t> tags(70);
  ModelView view;
  view.surface_mesh_tag = tags;
  view.modes_X = X;
  view.modes_packed = {{}, X8, scale, kinds, tilesOf(numbers)};
  for (const std::int64_t target : targets.list()) {
    hwy::SetSupportedTargetsForTest(target);
    const SeparatedField field(view);
    for (const float small : {1.0F, 0.5F, 0.3F, 0.0F, -0.3F, -1.0F})
      for (const float u : expanded(field, std::vector<float>{small, 1.0F}, 0.0F, numbers))
        ASSERT_NEAR(u, 127.0F * (1.0F + small), 0.1F) << hwy::TargetName(target) << ' ' << small;
  }
}

// What a shared byte adds to the number of a mode that is left out is left out too.
TEST(SeparatedField, WhatIsLeftOutMovesNoNodeByMoreThanIsUnseen) {
  const PackedField packed(100, {0, 26, 20, 26});
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

TEST(SeparatedField, NonFiniteAmplitudesShow) {
  for (const ModeCounts& counts : {ModeCounts{0, 4, 0, 0}, {0, 0, 4, 0}, {0, 0, 0, 4}}) {
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
