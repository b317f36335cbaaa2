// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>

#include "palpate/core/step_config.h"
#include "palpate/rt/scheduling.h"

namespace palpate::server {

/// What the server is told, by defaults, a file and the command line, in this order.
struct ServerConfig {
  std::filesystem::path model;                               ///< model file; no default
  std::int64_t domain{0};                                    ///< DDS domain, in [0, 230]
  double rate{1000.0};                                       ///< ticks per second, Hz, in [10, 10000]
  rt::RealtimePolicy realtime{rt::RealtimePolicy::kPrefer};  ///< require, prefer or off
  std::int64_t server_id{0};                                 ///< key of ServerStatus, in [0, 2^32 - 1]
  std::int64_t organ_id{0};                                  ///< key of the surface topics, in [0, 2^32 - 1]
  std::int64_t surface_every{1};                             ///< ticks per surface field, in [1, 1000]
  StepConfig step;  ///< tip radius, limits and ramps: [tool] in the file
};

/// An option that cannot be used. what() is one line: where it stands, what was found, what was expected.
class ConfigError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// What is wrong with one value.
struct Complaint {
  std::string key;   ///< as in the file, e.g. "tool.tip_radius"
  std::string text;  ///< e.g. "is 7, expected 10 to 10000 Hz"
};

/// @return the first value out of its range, if any. The model's existence is the loader's business.
[[nodiscard]] std::optional<Complaint> firstComplaint(const ServerConfig& config);

/// @throw ConfigError naming the words that are known
[[nodiscard]] rt::RealtimePolicy parsePolicy(const std::string& word);

/// Overwrites in `config` what the file (TOML) names; a relative model path is taken from the file's folder.
/// @throw ConfigError "file:line: ..." for a syntax error, an unknown key, a wrong type or a value out of
/// range
void readConfigFile(const std::filesystem::path& path, ServerConfig& config);

}  // namespace palpate::server
