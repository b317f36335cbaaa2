// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace palpate::fit {

/// One reading of depth and force.
struct MeasuredPoint {
  double depth;       ///< of the tool along its direction, from anywhere, m
  double force;       ///< of the tool on the organ, N
  double error{1.0};  ///< standard error of the force, N; all 1: they are alike and not known
};

/// Force against depth at one place.
struct MeasuredCurve {
  std::string name;                   ///< of the file, for messages
  std::vector<MeasuredPoint> points;  ///< in the order of the file
  bool has_errors{false};             ///< the file states the error of each force
};

/// Reads a table of text: a line that names the columns, then a line for each reading.
/// Columns are parted by tabs, semicolons or commas, whichever the first line has. They are named depth, force and, where
/// there is one, force_error, each with its unit: depth_mm, "depth [mm]", "depth (mm)" or depth/mm. Case
/// matters in units only: m, mm, um; N, mN, kN. Other columns, such as depth_rate_mm_s or force_filtered_N, empty lines and lines that
/// begin with # are left out.
/// @throw FitError naming file, line, column and what stands there
[[nodiscard]] MeasuredCurve readCurve(const std::filesystem::path& path);

/// The same of a text. @param name  of the file, for messages
[[nodiscard]] MeasuredCurve parseCurve(const std::string& name, const std::string& text);

}  // namespace palpate::fit
