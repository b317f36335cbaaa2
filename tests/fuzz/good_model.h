// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "core/data/array_reader.h"

namespace palpate::fuzz {

/// What a model file holds, not yet read.
struct GoodModel {
  struct Array {
    NumberType type{};
    std::vector<std::uint64_t> shape;
    std::vector<std::uint8_t> bytes;
  };
  std::map<std::string, ArrayReader::Attribute> attributes;
  std::map<std::string, Array> arrays;
};

inline constexpr std::size_t kGoodModels = 4;

/// A tetrahedron that readModel() and checkContents() take, with edges, regions, springs and a certificate.
/// @param kind  0 "displacement", 1 the same with quadratic elements, 2 "force", 3 "level"
[[nodiscard]] GoodModel goodModel(std::size_t kind);

}  // namespace palpate::fuzz
