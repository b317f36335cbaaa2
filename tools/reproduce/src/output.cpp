// SPDX-License-Identifier: Apache-2.0
#include "palpate/reproduce/output.h"

#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <sstream>
#include <utility>

namespace palpate::reproduce {

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
  const std::filesystem::path target = file(name);
  const std::filesystem::path beside = target.string() + ".tmp-" + std::to_string(getpid());
  std::ofstream out(beside, std::ios::binary);
  out << text;
  out.close();
  if (out && std::rename(beside.c_str(), target.c_str()) == 0) return;
  const int reason = errno;
  std::error_code ignored;
  std::filesystem::remove(beside, ignored);
  throw ReproduceError("cannot write " + target.string() + ": " + std::strerror(reason));
}

void Output::writeJson(const std::string& name, const Json& json) const {
  writeText(name, json.dump(2) + "\n");
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
