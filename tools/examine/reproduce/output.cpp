// SPDX-License-Identifier: Apache-2.0
#include "tools/examine/reproduce/output.h"

#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <sstream>
#include <utility>

#include "tools/program/write_file.h"

namespace palpate::reproduce {

std::vector<double> numbersOf(const Json& result, std::initializer_list<const char*> keys) {
  std::vector<double> numbers;
  for (const char* key : keys) numbers.push_back(result.at(key).get<double>());
  return numbers;
}

void addAll(Json& result, const Json& more) {
  for (const auto& [key, value] : more.members()) result[key] = value;
}

double now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

Output::Output(std::filesystem::path folder, bool quiet)
    : folder_(std::move(folder)), quiet_(quiet), start_(now()) {
  std::error_code error;
  std::filesystem::create_directories(folder_, error);
  if (!std::filesystem::is_directory(folder_))
    throw ReproduceError("--output " + folder_.string() + ": the folder cannot be made");
  if (access(folder_.c_str(), W_OK) != 0)
    throw ReproduceError("--output " + folder_.string() + ": the folder cannot be written");
}

void Output::step(const std::string& text) {
  ++steps_;
  if (!quiet_) std::fprintf(stderr, "%7.1f s  %2d. %s\n", now() - start_, steps_, text.c_str());
}

void Output::writeText(const std::string& name, const std::string& text) const {
  program::writeFile(file(name), text);
}

void Output::writeJson(const std::string& name, const Json& json) const {
  writeText(name, json.dump(2, program::Keys::kAsWritten) + "\n");
}

void Output::writeCsv(const std::string& name, std::initializer_list<const char*> columns,
                      const std::vector<std::vector<double>>& rows) const {
  std::ostringstream text;
  text.precision(12);
  const char* separator = "";
  for (const char* column : columns) text << std::exchange(separator, ",") << column;
  for (const std::vector<double>& row : rows) {
    separator = "\n";
    for (const double x : row) text << std::exchange(separator, ",") << x;
  }
  writeText(name, text.str() + "\n");
}

}  // namespace palpate::reproduce
