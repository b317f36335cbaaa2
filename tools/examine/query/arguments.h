// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

#include "core/base/types.h"

namespace palpate::query {

/// A surface node by its number in the mesh file, and a vector.
struct NodeAndVector {
  std::int64_t node{0};
  Vec3 vector = Vec3::Zero();
};

/// "1204:x,y,z" as that and nothing else. @param option  for the message  @throw program::ValueError naming option and text
[[nodiscard]] NodeAndVector parseNodeAndVector(const std::string& option, const std::string& text);

}  // namespace palpate::query
