// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "palpate/client/path.h"
#include "palpate/client/time_summary.h"

namespace palpate::report {

/// Runs a program's body; an exception becomes one line on standard error and exit code 1.
int runProgram(const char* name, int (*body)(int argc, char** argv), int argc, char** argv);

/// "x,y,z" as three finite numbers. @throw client::ClientError naming `option` and the text
[[nodiscard]] client::Point parsePoint(const std::string& option, const std::string& text);

/// Names of the bits of ToolForce::flags, joined by " "; "-" for none.
[[nodiscard]] std::string flagNames(std::uint32_t flags);

/// {p50, p99, p999, max, count}, us.
[[nodiscard]] nlohmann::json toJson(const client::TimeSummary& summary);

/// Prints one object on standard output; text that is not UTF-8 is mended, not thrown at.
void printJson(const nlohmann::json& object);

/// Writes beside the target and renames, so that nobody reads half a file.
/// @throw client::ClientError naming the file and the reason
void writeFile(const std::filesystem::path& path, const std::string& content);

}  // namespace palpate::report
