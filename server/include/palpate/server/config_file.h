// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "palpate/server/config.h"

namespace palpate::server {

/// Overwrites in `config` what the file (TOML) names; a relative model path is taken from the file's folder.
/// Applies the device preset; deviceComplaint() checks the coupling against it later.
/// @throw ConfigError "file:line: ..." for a syntax error, an unknown key, a wrong type or a value out of
/// range
void readConfigFile(const std::filesystem::path& path, ServerConfig& config);

/// The same of a text. @param[in] path  of its file, for messages and relative paths
void parseConfig(const std::filesystem::path& path, const std::string& text, ServerConfig& config);

}  // namespace palpate::server
