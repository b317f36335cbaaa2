// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <vector>

#include "palpate/core/types.h"

namespace palpate::query {

/// "x,y,z" as three finite numbers and nothing else.
/// @param option  for the message  @throw QueryError naming option and text
[[nodiscard]] Vec3 parseVector(const std::string& option, const std::string& text);

/// The command line with "--option -1,2,3" written as "--option=-1,2,3", so that no parser takes a negative
/// number for an option. @param options  those that take a vector
[[nodiscard]] std::vector<std::string> joinVectors(std::span<const char* const> words,
                                                   std::span<const char* const> options);

}  // namespace palpate::query
