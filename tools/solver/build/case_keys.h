// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace palpate::solver {

/// One key of a case file: what the reader accepts and what the template says. Declared once, here and in case_keys.cpp.
struct CaseKey {
  /// Numbers are in [low, high], or above low where it is not included. Whole ones take no fraction.
  enum class Type { kWord, kFlag, kNumber, kWhole, kVector };

  std::string_view table;  ///< "model"; "region" and "spring" are arrays of tables
  std::string_view name;
  Type type{Type::kWord};
  double low{0.0}, high{0.0};
  bool low_included{true};
  std::string_view unit;   ///< empty: none
  std::string_view value;  ///< as TOML: the default, or an example where `active` is false
  bool active{false};      ///< whether `value` is the default whatever the mesh and the method
  std::string_view help;   ///< one line
};

/// All keys, those of one table together, in the order of the template.
[[nodiscard]] std::span<const CaseKey> caseKeys();

/// @throw std::logic_error when there is none: a slip of the reader's
[[nodiscard]] const CaseKey& caseKey(std::string_view table, std::string_view name);

/// "above 0, at most 0.05 m", "1 to 7", or empty where there is no range.
[[nodiscard]] std::string rangeText(const CaseKey& key);

/// A case file with every key: its default, unit and range. Keys whose default depends on the mesh or the method are comments.
/// @param mesh  which the case names  @param accessible  the mesh has a group of that name: its key is no comment
[[nodiscard]] std::string caseTemplate(const std::string& mesh, bool accessible);

}  // namespace palpate::solver
