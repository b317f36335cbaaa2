// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "tools/modelfile/model_data.h"
#include "tools/solver/build/build_options.h"

namespace palpate::solver {

/// By node of the near fields of contact positions and of Green's functions, how far it is moved over abs(d), at most.
struct NearSizes {
  std::vector<float> positions, greens;
};

/// What of a compact model file goes where, by its limit.                              docs/decisions/handheld.md
class SizeBudget {
 public:
  /// @param data  with all but its fields  @param sources  of Green's functions  @param limit  of the file, bytes
  SizeBudget(const modelfile::ModelData& data, std::size_t sources, double limit);

  /// The number of modes that takes its part of what is left for fields; at least kFewestModes.
  [[nodiscard]] int modes() const;
  /// Leaves out of near fields what is least until the file is within its limit: nodes that are moved by less than a part of
  /// abs(d), and from those that are moved by little more that much, so that no step is seen where near fields end.
  /// @param data  with its fields  @param sizes  of its near fields
  [[nodiscard]] SizeChoice leaveOut(const NearSizes& sizes, modelfile::ModelData& data) const;

  static constexpr int kFewestModes = 12, kMostModes = 400;
  /// Of n modes those that orders of two and more have.
  [[nodiscard]] static constexpr std::ptrdiff_t positionModes(std::ptrdiff_t n) { return (n + 2) / 3; }

 private:
  double limit_, fixed_;
  double mode_, position_mode_;        // bytes of a mode: what positions have of it, and all else
  double position_node_, green_node_;  // bytes of a node in a near field
};

/// The part of abs(d) below which nodes have to be left out, so that the others take at most `room` bytes.
/// @param position_node, green_node  bytes of a node in either kind of near field
[[nodiscard]] double leastKept(const NearSizes& sizes, double position_node, double green_node, double room);

/// Leaves out nodes that are moved by less than `least` of abs(d), and shrinks others by 1 - (least / size)^8.
/// @param rows  coefficients of each source  @param offset, node, field  of the near fields, as in ModelData
void leaveOutBelow(double least, const std::vector<float>& sizes, std::size_t rows,
                   std::vector<std::int64_t>& offset, std::vector<std::int32_t>& node,
                   std::vector<float>& field);

}  // namespace palpate::solver
