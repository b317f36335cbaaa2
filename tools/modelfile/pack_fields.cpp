// SPDX-License-Identifier: Apache-2.0
#include "tools/modelfile/pack_fields.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "tools/modelfile/check_sizes.h"

namespace palpate::modelfile {

namespace {

float scaleFor(std::span<const float> block, float most) {
  float largest = 0.0F;
  for (const float number : block) {
    if (!std::isfinite(number)) return number;
    largest = std::max(largest, std::abs(number));
  }
  return std::max(largest / most, std::numeric_limits<float>::min());
}

/// Raises the share of each mode to its largest amplitude over the largest of all. @param n  modes that Y has
void raiseShares(std::span<const float> Y, std::size_t n, std::span<float> share) {
  std::vector<float> largest(share.size(), 0.0F);
  for (std::size_t i = 0; i < Y.size(); ++i)
    if (std::isfinite(Y[i])) largest[i % n] = std::max(largest[i % n], std::abs(Y[i]));
  const float most = largest.empty() ? 0.0F : *std::max_element(largest.begin(), largest.end());
  for (std::size_t k = 0; k < share.size() && most > 0.0F; ++k)
    share[k] = std::max(share[k], largest[k] / most);
}

/// Y_k / share_k. Without modes too, each row has its scale.
void addAmplitudes(std::span<const float> Y, std::size_t rows, std::span<const float> share,
                   PackedNumbers& to) {
  const std::size_t n = share.size();  // modes that Y has
  std::vector<float> row(n);
  for (std::size_t r = 0; r < rows; ++r) {
    for (std::size_t k = 0; k < n; ++k) row[k] = Y[r * n + k] / share[k];
    to.add(row);
  }
}

/// @param from  rows of so many numbers each
std::vector<std::int16_t> transposed(std::span<const std::int16_t> from, std::size_t length) {
  std::vector<std::int16_t> to(from.size());
  const std::size_t rows = length == 0 ? 0 : from.size() / length;
  for (std::size_t r = 0; r < rows; ++r)
    for (std::size_t i = 0; i < length; ++i) to[i * rows + r] = from[r * length + i];
  return to;
}

/// X_k share_k and Y_k / share_k: a row of Y has one scale, and would round weak modes as coarsely as strong ones.
void packModes(const ModelData& data, PackedFields& to) {
  const std::size_t n = modeCount(data), nY = positionModes(data), numbers = 3 * data.surface_mesh_tag.size();
  std::vector<float> share(n, 0.0F), mode(numbers);
  raiseShares(data.modes_Y, nY, share);
  raiseShares(data.green_Y, n, share);
  for (float& s : share) s = s > 0.0F ? s : 1.0F;  // of a mode without amplitudes
  for (std::size_t k = 0; k < n; ++k) {
    for (std::size_t i = 0; i < numbers; ++i) mode[i] = share[k] * data.modes_X[k * numbers + i];
    to.X.add(mode);
  }
  to.X.whole = transposed(to.X.whole, numbers);
  const std::size_t Cm = modeCoefficients(data.attributes, fieldCoefficients(data));
  addAmplitudes(data.modes_Y, data.contact_node.size() * Cm, std::span(share).first(nY), to.Y);
  addAmplitudes(data.green_Y, data.green_node.size() * kLinearCoefficients, share, to.green_Y);
}

void addBlocks(std::span<const float> numbers, std::size_t blocks, PackedNumbers& to) {
  const std::size_t length = blocks == 0 ? 0 : numbers.size() / blocks;
  for (std::size_t b = 0; b < blocks; ++b) to.add(numbers.subspan(b * length, length));
}

/// Blocks of near nodes, `rows` of three numbers a node each.
void packNear(std::span<const float> near, std::span<const std::int64_t> offset, std::size_t rows,
              PackedNumbers& to) {
  const auto end = rows == 0 ? 0 : static_cast<std::int64_t>(near.size() / (3 * rows));
  const auto numbers = [&](std::int64_t nodes) { return 3 * rows * static_cast<std::size_t>(nodes); };
  for (std::size_t m = 0; m + 1 < offset.size(); ++m) {
    // Offsets that make no sense are the reader's to refuse.
    const std::int64_t first = std::clamp<std::int64_t>(offset[m], 0, end);
    const std::int64_t last = std::clamp(offset[m + 1], first, end);
    addBlocks(near.subspan(numbers(first), numbers(last - first)), rows, to);
  }
  to.whole.resize(near.size());
}

/// Of each source [rows][K][3] as [K][rows][3].
void sortByNode(std::span<const std::int64_t> offset, std::size_t rows, std::vector<std::int16_t>& whole) {
  std::vector<std::int16_t> sorted(whole.size());
  const auto nodes = static_cast<std::int64_t>(whole.size() / (3 * rows));
  for (std::size_t g = 0; g + 1 < offset.size(); ++g) {
    const auto first = static_cast<std::size_t>(std::clamp<std::int64_t>(offset[g], 0, nodes)),
               end = static_cast<std::size_t>(
                   std::clamp<std::int64_t>(offset[g + 1], std::int64_t(first), nodes));
    for (std::size_t row = 0; row < rows; ++row)
      for (std::size_t i = first; i < end; ++i)
        std::copy_n(whole.data() + 3 * (rows * first + row * (end - first) + i - first), 3,
                    sorted.data() + 3 * (rows * i + row));
  }
  whole = std::move(sorted);
}

}  // namespace

void PackedNumbers::add(std::span<const float> block) {
  scale.push_back(scaleFor(block, most));
  for (const float number : block) {
    const float steps = std::isfinite(scale.back()) ? std::nearbyint(number / scale.back()) : 0.0F;
    whole.push_back(static_cast<std::int16_t>(std::clamp(steps, -most, most)));
  }
}

PackedFields packFields(const ModelData& data) {
  PackedFields packed;
  if (data.compact)
    for (PackedNumbers* part :
         {&packed.X, &packed.Y, &packed.near, &packed.green_Y, &packed.green_near, &packed.edges})
      part->most = 127.0F;
  packModes(data, packed);
  packNear(data.near_field, data.near_offset, modeCoefficients(data.attributes, fieldCoefficients(data)),
           packed.near);
  packNear(data.green_near, data.green_offset, kLinearCoefficients, packed.green_near);
  sortByNode(data.green_offset, kLinearCoefficients, packed.green_near.whole);
  packNear(data.edge_field, data.edge_offset, edgeCoefficients(data), packed.edges);
  return packed;
}

}  // namespace palpate::modelfile
