// SPDX-License-Identifier: Apache-2.0
#include "palpate/report/program.h"

#include <unistd.h>

#include <array>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>
#include <fstream>
#include <iostream>
#include <utility>

#include "palpate/client/error.h"
#include "palpate/idl/types.h"

namespace palpate::report {

int runProgram(const char* name, int (*body)(int argc, char** argv), int argc, char** argv) {
  try {
    return body(argc, argv);
  } catch (const std::exception& error) {
    std::cerr << name << ": " << error.what() << '\n';
    return 1;
  }
}

client::Point parsePoint(const std::string& option, const std::string& text) {
  client::Point point{};
  const char* at = text.data();
  const char* const end = at + text.size();
  for (std::size_t i = 0; i < 3; ++i) {
    const auto [next, failure] = std::from_chars(at, end, point[i]);
    const bool ends_well = i < 2 ? next != end && *next == ',' : next == end;
    if (failure != std::errc() || !ends_well || !std::isfinite(point[i]))
      throw client::ClientError(option + " is '" + text + "', expected three finite numbers x,y,z");
    at = next + 1;
  }
  return point;
}

std::string flagNames(std::uint32_t flags) {
  std::string names;
  for (const auto& [bit, name] : dds::flag::kWords)
    if ((flags & bit) != 0) {
      if (!names.empty()) names += ' ';
      names += name;
    }
  return names.empty() ? "-" : names;
}

nlohmann::json toJson(const client::TimeSummary& summary) {
  return {{"p50", summary.p50},
          {"p99", summary.p99},
          {"p999", summary.p999},
          {"max", summary.max},
          {"count", summary.count}};
}

void printJson(const nlohmann::json& object) {
  std::cout << object.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace) << std::endl;
}

void writeFile(const std::filesystem::path& path, const std::string& content) {
  const std::filesystem::path beside = path.string() + ".tmp-" + std::to_string(getpid());
  std::ofstream file(beside, std::ios::binary);
  file << content;
  file.close();
  if (!file) {
    const int reason = errno;
    std::error_code ignored;
    std::filesystem::remove(beside, ignored);  // nothing to clean up when it was never made
    throw client::ClientError("cannot write " + path.string() + ": " + std::strerror(reason));
  }
  std::error_code failure;
  std::filesystem::rename(beside, path, failure);
  if (failure) throw client::ClientError("cannot write " + path.string() + ": " + failure.message());
}

}  // namespace palpate::report
