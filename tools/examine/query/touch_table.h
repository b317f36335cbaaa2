// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "tools/program/length_unit.h"

namespace palpate::query {

/// One touch of --batch, as the file has it.
struct TouchRow {
  program::AskedPlace at, displacement;  ///< their names say file, line and columns
};

/// The columns of --batch, all of them required, in any order.
inline constexpr std::array<std::string_view, 6> kTouchColumns{
    "at_x", "at_y", "at_z", "displacement_x", "displacement_y", "displacement_z"};

/// Reads touches from comma-separated text. The first line names the columns; empty lines and lines that begin with # say nothing.
/// @param name  of the file, for messages
/// @throw QueryError naming file, line and column
[[nodiscard]] std::vector<TouchRow> touchesIn(const std::string& name, std::string_view text,
                                              const program::LengthUnit& unit);

/// The same of a file. @throw QueryError also when it cannot be read
[[nodiscard]] std::vector<TouchRow> readTouches(const std::filesystem::path& path,
                                                const program::LengthUnit& unit);

}  // namespace palpate::query
