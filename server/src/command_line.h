// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "palpate/server/config.h"

namespace palpate::server {

/// Options of palpate-server: defaults, then --config, then what stands on the command line.
/// @return nothing after --help or --version
/// @throw ConfigError with one line naming the option or the file and line
[[nodiscard]] std::optional<ServerConfig> parseCommandLine(int argc, char** argv);

}  // namespace palpate::server
