// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>

#include "palpate/server/config.h"

namespace palpate::server {

/// The tip radius in --tool and --limit.
inline constexpr const char* kTipRadius = "tip-radius";

/// --limit: "friction=0:0.5". @throw ConfigError
void takeLimit(const std::string& word, ServerConfig& config);

/// --tool: "1:device=omni,tip-radius=0.004". @throw ConfigError
void takeTool(const std::string& word, std::array<OwnOptions, kMaxTools>& all);

}  // namespace palpate::server
