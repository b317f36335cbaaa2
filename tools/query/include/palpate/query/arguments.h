// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "palpate/core/types.h"

namespace palpate::query {

/// "x,y,z" as three finite numbers and nothing else.
/// @param option  for the message  @throw QueryError naming option and text
[[nodiscard]] Vec3 parseVector(const std::string& option, const std::string& text);

/// A surface node by its number in the mesh file, and a vector.
struct NodeAndVector {
  std::int64_t node{0};
  Vec3 vector = Vec3::Zero();
};

/// "1204:x,y,z" as that and nothing else. @param option  for the message  @throw QueryError naming option and text
[[nodiscard]] NodeAndVector parseNodeAndVector(const std::string& option, const std::string& text);

/// The command line with "--option -1,2,3" written as "--option=-1,2,3", so that no parser takes a negative
/// number for an option. @param options  those that take a vector
[[nodiscard]] std::vector<std::string> joinVectors(std::span<const char* const> words,
                                                   std::span<const char* const> options);

}  // namespace palpate::query
