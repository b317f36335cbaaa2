// SPDX-License-Identifier: Apache-2.0
#include "tools/solver/build/size_budget.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <utility>

#include "core/base/index.h"
#include "tools/modelfile/check_sizes.h"
#include "tools/modelfile/write_model.h"

namespace palpate::solver {

namespace {

constexpr double kModesPart = 0.45;  // of what is left for fields; the near fields have the rest
constexpr double kSlack = 16384.0;   // bytes: of provenance

}  // namespace

SizeBudget::SizeBudget(const modelfile::ModelData& data, std::size_t sources, double limit) : limit_(limit) {
  const auto C = static_cast<std::size_t>(MonomialBasis::size(data.attributes.order));
  const double rows = static_cast<double>(modeCoefficients(data.attributes, C));
  const double M = static_cast<double>(data.contact_node.size()), G = static_cast<double>(sources);
  const double nodes = static_cast<double>(data.surface_mesh_tag.size());
  const double number = nodes <= std::numeric_limits<std::int16_t>::max() ? 2.0 : 4.0;
  // Scales of Y and near fields, where near fields begin, and the sources' nodes.
  fixed_ = static_cast<double>(modelfile::storedBytes(data)) + kSlack + M * (8.0 * rows + 4.0) +
           G * (24.0 + 4.0 + number);
  mode_ = 3.0 * nodes + 4.0 + 3.0 * G;
  position_mode_ = M * rows;
  position_node_ = number + 3.0 * rows;
  green_node_ = number + 9.0;
}

int SizeBudget::modes() const {
  const double many = kModesPart * (limit_ - fixed_) / (mode_ + position_mode_ / 3.0);
  return static_cast<int>(std::clamp<double>(many, kFewestModes, kMostModes));
}

double leastKept(const NearSizes& sizes, double position_node, double green_node, double room) {
  std::vector<std::pair<float, double>> all;
  for (const float size : sizes.positions) all.emplace_back(size, position_node);
  for (const float size : sizes.greens) all.emplace_back(size, green_node);
  std::sort(all.begin(), all.end(), std::greater<>());
  double bytes = 0.0;
  for (const auto& [size, own] : all) {
    bytes += own;
    if (bytes > room) return std::nextafter(size, std::numeric_limits<float>::infinity());
  }
  return 0.0;
}

void leaveOutBelow(double least, const std::vector<float>& sizes, std::size_t rows,
                   std::vector<std::int64_t>& offset, std::vector<std::int32_t>& node,
                   std::vector<float>& field) {
  std::vector<std::int32_t> kept_node;
  std::vector<float> kept_field;
  std::vector<std::int64_t> kept_offset{0};
  for (std::size_t m = 0; m + 1 < offset.size(); ++m) {
    const std::size_t first = index(offset[m]), K = index(offset[m + 1]) - first;
    for (std::size_t j = 0; j < K; ++j)
      if (double{sizes[first + j]} >= least) kept_node.push_back(node[first + j]);
    for (std::size_t row = 0; row < rows; ++row)
      for (std::size_t j = 0; j < K; ++j) {
        const double size = double{sizes[first + j]};
        if (size < least) continue;
        const auto share = static_cast<float>(size > 0.0 ? 1.0 - std::pow(least / size, 8.0) : 1.0);
        for (std::size_t axis = 0; axis < 3; ++axis)
          kept_field.push_back(share * field[3 * (rows * first + row * K + j) + axis]);
      }
    kept_offset.push_back(static_cast<std::int64_t>(kept_node.size()));
  }
  offset = std::move(kept_offset);
  node = std::move(kept_node);
  field = std::move(kept_field);
}

SizeChoice SizeBudget::leaveOut(const NearSizes& sizes, modelfile::ModelData& data) const {
  const std::size_t rows =
      modeCoefficients(data.attributes, static_cast<std::size_t>(MonomialBasis::size(data.attributes.order)));
  const double modes = mode_ * static_cast<double>(modelfile::modeCount(data)) +
                       position_mode_ * static_cast<double>(modelfile::positionModes(data));
  SizeChoice choice{limit_, fixed_, modes};
  choice.left_out = leastKept(sizes, position_node_, green_node_, limit_ - fixed_ - modes);
  leaveOutBelow(choice.left_out, sizes.positions, rows, data.near_offset, data.near_node, data.near_field);
  leaveOutBelow(choice.left_out, sizes.greens, kLinearCoefficients, data.green_offset, data.green_near_node,
                data.green_near);
  choice.near_fields = position_node_ * static_cast<double>(data.near_node.size()) +
                       green_node_ * static_cast<double>(data.green_near_node.size());
  return choice;
}

}  // namespace palpate::solver
