// SPDX-License-Identifier: Apache-2.0
#include "tools/modelfile/pack_fields.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "tools/modelfile/check_sizes.h"

namespace palpate::modelfile {

namespace {

float scaleFor(std::span<const float> block) {
  float most = 0.0F;
  for (const float number : block) {
    if (!std::isfinite(number)) return number;
    most = std::max(most, std::abs(number));
  }
  return std::max(most / 32767.0F, std::numeric_limits<float>::min());
}

/// Largest amplitude of each mode over the largest of all, 1 for a mode without any.
std::vector<float> sharesOf(std::span<const float> Y, std::size_t modes) {
  std::vector<float> share(modes, 0.0F);
  for (std::size_t i = 0; i < Y.size(); ++i)
    if (std::isfinite(Y[i])) share[i % modes] = std::max(share[i % modes], std::abs(Y[i]));
  const float most = share.empty() ? 0.0F : *std::max_element(share.begin(), share.end());
  for (float& s : share) s = s > 0.0F ? s / most : 1.0F;
  return share;
}

/// X_k share_k and Y_k / share_k: a row of Y has one scale, and would round weak modes as coarsely as strong ones.
void packModes(const ModelData& data, std::size_t rows, PackedFields& to) {
  const std::size_t n = modeCount(data), numbers = 3 * data.surface_mesh_tag.size();
  const std::vector<float> share = sharesOf(data.modes_Y, n);
  std::vector<float> mode(numbers), row(n);
  for (std::size_t k = 0; k < n; ++k) {
    for (std::size_t i = 0; i < numbers; ++i) mode[i] = share[k] * data.modes_X[k * numbers + i];
    to.X.add(mode);
  }
  for (std::size_t r = 0; r < rows; ++r) {
    for (std::size_t k = 0; k < n; ++k) row[k] = data.modes_Y[r * n + k] / share[k];
    to.Y.add(row);
  }
}

void addBlocks(std::span<const float> numbers, std::size_t blocks, PackedNumbers& to) {
  const std::size_t length = blocks == 0 ? 0 : numbers.size() / blocks;
  for (std::size_t b = 0; b < blocks; ++b) to.add(numbers.subspan(b * length, length));
}

}  // namespace

void PackedNumbers::add(std::span<const float> block) {
  scale.push_back(scaleFor(block));
  for (const float number : block) {
    const float steps = std::isfinite(scale.back()) ? std::nearbyint(number / scale.back()) : 0.0F;
    whole.push_back(static_cast<std::int16_t>(std::clamp(steps, -32767.0F, 32767.0F)));
  }
}

PackedFields packFields(const ModelData& data) {
  const std::size_t C = fieldCoefficients(data);
  const std::span<const float> near = data.near_field;
  const auto end = static_cast<std::int64_t>(data.near_node.size());
  PackedFields packed;
  packModes(data, data.contact_node.size() * C, packed);
  for (std::size_t m = 0; m < data.contact_node.size(); ++m) {
    // Offsets that make no sense are the reader's to refuse.
    const std::int64_t first = std::clamp<std::int64_t>(data.near_offset[m], 0, end);
    const std::int64_t last = std::clamp(data.near_offset[m + 1], first, end);
    const auto numbers = [&](std::int64_t nodes) { return 3 * C * static_cast<std::size_t>(nodes); };
    addBlocks(near.subspan(numbers(first), numbers(last - first)), C, packed.near);
  }
  packed.near.whole.resize(near.size());
  return packed;
}

}  // namespace palpate::modelfile
