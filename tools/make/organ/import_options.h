// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "tools/make/organ/boundary_groups.h"
#include "tools/mesh/element_sizes.h"

namespace palpate::organ {

constexpr double kMaxNodes = 100'000;  ///< more take palpate-solve hours, and tens of GB

/// How a file becomes an organ.
struct ImportOptions {
  double scale{1};             ///< metres per unit of the file, positive
  mesh::ElementSizes sizes{};  ///< of a surface (.stl, .obj) and what fills it; all 0 by default
  std::optional<int> order{};  ///< of the elements, 1 or 2; absent: that of the file, 1 of a surface
  FixedRules fixed{};
  bool repair{false};                 ///< a surface is repaired first
  std::optional<std::string> part{};  ///< of a surface of several: "largest", or a number from 1 by size
  double max_nodes{kMaxNodes};        ///< a surface is not filled when more are to be expected
  /// Takes what is known before the organ is there, one line each.
  std::function<void(const std::string&)> say = [](const std::string&) {};
  /// Takes how far a filling is, every few seconds, from another thread; empty: nobody wants to know.
  std::function<void(const std::string&)> progress{};
};

}  // namespace palpate::organ
