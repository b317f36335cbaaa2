// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <toml++/toml.h>

#include <cstdint>
#include <optional>
#include <set>
#include <sstream>
#include <string>
#include <utility>

#include "tools/solver/build/case_error.h"
#include "tools/solver/build/case_keys.h"

namespace palpate::solver {

/// One table of a case file. Each key is taken once; keys left at the end are unknown.
class Section {
 public:
  Section(const std::string& file, std::string name, const toml::table& table)
      : file_(file), name_(std::move(name)), table_(table) {}

  template <typename T>
  std::optional<T> take(const std::string& key, const char* type) {
    known_.insert(key);
    const toml::node* node = table_.get(key);
    if (node == nullptr) return std::nullopt;
    const std::optional<T> value = node->value_exact<T>();
    if (!value) refuse(*node, key, std::string("is not ") + type);
    return value;
  }

  /// A number, integers included, in the range that case_keys.cpp declares.
  std::optional<double> number(const std::string& key) {
    const auto [low, high, low_included] = rangeOf(key);
    known_.insert(key);
    const toml::node* node = table_.get(key);
    if (node == nullptr) return std::nullopt;
    if (!node->is_number()) refuse(*node, key, "is not a number");
    const double x = *node->value<double>();
    if (!(low_included ? x >= low : x > low) || !(x <= high)) {
      std::ostringstream why;
      why << "= " << x << " is out of range " << (low_included ? "[" : "(") << low << ", " << high << "]";
      refuse(*node, key, why.str());
    }
    return x;
  }

  std::optional<int> integer(const std::string& key) {
    const Range range = rangeOf(key);
    const auto low = static_cast<std::int64_t>(range.low), high = static_cast<std::int64_t>(range.high);
    const std::optional<std::int64_t> x = take<std::int64_t>(key, "an integer");
    if (x && (*x < low || *x > high))
      refuse(*table_.get(key), key,
             "= " + std::to_string(*x) + " is out of range [" + std::to_string(low) + ", " +
                 std::to_string(high) + "]");
    return x ? std::optional<int>(static_cast<int>(*x)) : std::nullopt;
  }

  const toml::table* table(const std::string& key) {
    known_.insert(key);
    const toml::node* node = table_.get(key);
    if (node != nullptr && !node->is_table()) refuse(*node, key, "is not a table");
    return node == nullptr ? nullptr : node->as_table();
  }

  const toml::node* find(const std::string& key) {
    known_.insert(key);
    return table_.get(key);
  }

  void refuseTheRest() const {
    for (const auto& [key, node] : table_) {
      if (known_.count(std::string(key.str())) != 0) continue;
      std::string list;
      for (const std::string& name : known_) list += (list.empty() ? "" : ", ") + name;
      refuse(node, std::string(key.str()), "is not known here (known: " + list + ")");
    }
  }

  /// Calls body with each table of [[key]].
  template <typename Body>
  void tables(const std::string& key, const Body& body) {
    known_.insert(key);
    const toml::node* node = table_.get(key);
    if (node == nullptr) return;
    if (!node->is_array_of_tables()) refuse(*node, key, "is not an array of tables, [[" + key + "]]");
    for (const toml::node& entry : *node->as_array()) {
      Section section(file_, key, *entry.as_table());
      body(section);
      section.refuseTheRest();
    }
  }

  /// What has to be there. @param value  as taken
  template <typename T>
  T required(const std::string& key, const std::optional<T>& value) const {
    if (!value) refuse(table_, key, "is missing");
    return *value;
  }

  /// File, line and key.
  [[nodiscard]] std::string placeOf(const toml::node& node, const std::string& key) const {
    return file_ + ":" + std::to_string(node.source().begin.line) + ": " +
           (name_.empty() ? key : name_ + "." + key);
  }
  [[noreturn]] void refuse(const toml::node& node, const std::string& key, const std::string& why) const {
    throw CaseError(placeOf(node, key) + " " + why);
  }
  [[nodiscard]] const toml::node& node(const std::string& key) const { return *table_.get(key); }

 private:
  struct Range {
    double low, high;
    bool low_included;
  };
  [[nodiscard]] Range rangeOf(const std::string& key) const {
    const CaseKey& declared = caseKey(name_, key);
    return {declared.low, declared.high, declared.low_included};
  }

  const std::string& file_;
  std::string name_;
  const toml::table& table_;
  std::set<std::string> known_;
};

}  // namespace palpate::solver
