// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstring>
#include <span>
#include <string>
#include <vector>

#include "palpate/testing/synthetic_model.h"
#include "spoiled_file.h"
#include "tools/modelfile/write_model.h"

namespace palpate::testing {

/// A model that is small and right, to be spoiled.
inline const modelfile::ModelData& goodData() {
  static const modelfile::ModelData data = syntheticModel({.subdivisions = 1, .modes = 2});
  return data;
}

/// The same of each kind.
inline modelfile::ModelData goodData(Parameters parameters) {
  return syntheticModel({.subdivisions = 1, .modes = 2, .parameters = parameters});
}

/// One way in which a model file can be wrong, and what is said of it.
struct LoadCase {
  std::string name;
  std::string expected;
};

inline constexpr auto kCaseName = [](const auto& test) { return test.param.name; };

template <typename T>
bool sameBits(const std::vector<T>& a, std::span<const T> b) {
  return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), b.size_bytes()) == 0);
}
inline bool sameBits(const std::vector<std::int16_t>& a, const WholeNumbers& b) {
  return b.int8() == nullptr && sameBits(a, std::span<const std::int16_t>(b.int16(), b.size()));
}

}  // namespace palpate::testing
