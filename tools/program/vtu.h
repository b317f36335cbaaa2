// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <variant>
#include <vector>

namespace palpate::program {

/// Numbers at the points of a surface, one point after the other.
struct PointData {
  std::string name;
  /// as many as points, or three times as many: a vector each
  std::variant<std::vector<float>, std::vector<double>, std::vector<std::int64_t>, std::vector<std::uint8_t>>
      values;
};

/// A surface of triangles with data at its points.
struct PointSurface {
  std::vector<double> points;           ///< [N][3] m
  std::vector<std::int64_t> triangles;  ///< [T][3] 0-based points
  std::vector<PointData> data;          ///< the first that holds vectors is the one ParaView warps by
};

/// The surface as VTK XML (.vtu), ASCII. Each number is the shortest text that reads back as the same number.
/// @throw std::invalid_argument when a size fits neither N nor 3 N, or points or triangles are not a multiple of 3
[[nodiscard]] std::string vtuText(const PointSurface& surface);

}  // namespace palpate::program
