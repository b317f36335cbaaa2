// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <initializer_list>
#include <stdexcept>
#include <string>
#include <vector>

#include "tools/program/json.h"

namespace palpate::reproduce {

using program::Json;

/// An option, a file or a folder stops the run. what() is one line that names it.
class ReproduceError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The folder of one benchmark, and its steps on standard error.
class Output {
 public:
  /// Makes the folder. @throw ReproduceError when it cannot be made or written
  Output(std::filesystem::path folder, bool quiet);

  /// "3. text" on standard error, with the time since the start.
  void step(const std::string& text);
  [[nodiscard]] std::filesystem::path file(const std::string& name) const { return folder_ / name; }
  [[nodiscard]] bool quiet() const noexcept { return quiet_; }

  /// Writes a file beside the target and renames it. @throw program::WriteError naming the file
  void writeText(const std::string& name, const std::string& text) const;
  void writeJson(const std::string& name, const Json& json) const;
  /// One line of column names, then the rows. @param rows  each as long as columns
  void writeCsv(const std::string& name, std::initializer_list<const char*> columns,
                const std::vector<std::vector<double>>& rows) const;

 private:
  std::filesystem::path folder_;
  bool quiet_;
  int steps_{0};
  double start_;
};

/// The numbers of a result, in the order of the keys. @throw program::JsonError naming a missing key
[[nodiscard]] std::vector<double> numbersOf(const Json& result, std::initializer_list<const char*> keys);

/// Copies the members of `more` into `result`. @throw program::JsonError unless both are objects
void addAll(Json& result, const Json& more);

/// Seconds of a steady clock.
[[nodiscard]] double now();

}  // namespace palpate::reproduce
