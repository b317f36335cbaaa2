// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <sstream>
#include <string>
#include <vector>

namespace palpate::query::test {

/// A deck read back: the lines under each keyword, cut at the commas.
struct ParsedDeck {
  using Fields = std::vector<std::string>;
  std::map<std::string, std::vector<Fields>> under;  ///< keyword line -> data lines
  std::vector<std::string> keywords;                 ///< in order

  explicit ParsedDeck(const std::string& text) {
    std::istringstream in(text);
    for (std::string line; std::getline(in, line);) {
      if (line.rfind("**", 0) == 0) continue;
      if (line.rfind('*', 0) == 0)
        keywords.push_back(line);
      else
        under[keywords.back()].push_back(cut(line));
    }
  }

  static Fields cut(const std::string& line) {
    Fields fields;
    std::istringstream in(line);
    for (std::string field; std::getline(in, field, ',');) fields.push_back(field);
    return fields;
  }
};

}  // namespace palpate::query::test
