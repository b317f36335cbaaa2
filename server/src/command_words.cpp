// SPDX-License-Identifier: Apache-2.0
#include "command_words.h"

#include <cstddef>
#include <cstdlib>
#include <sstream>

namespace palpate::server {
namespace {

[[noreturn]] void refuseLimit(const std::string& word) {
  std::string names;
  for (const LiveParameterInfo& info : kLiveParameters) names += std::string(&info.option[2]) + " ";
  throw ConfigError("--limit is \"" + word + "\", expected NAME=LOW:HIGH, NAME one of " + names + kTipRadius);
}

[[noreturn]] void refuseTool(const std::string& word) {
  throw ConfigError("--tool is \"" + word + "\", expected ID:NAME=VALUE,... with ID 0 to 3, see --help");
}

// "friction" and "0.5" of a tool.
bool takeOwn(const std::string& name, const std::string& value, OwnOptions& own) {
  if (name == "device") {
    own.device = value;
    return true;
  }
  char* end = nullptr;
  const double number = std::strtod(value.c_str(), &end);
  if (value.empty() || *end != '\0') return false;
  if (name == kTipRadius || name == "rendered-stiffness") {
    (name == kTipRadius ? own.tip_radius : own.rendered_stiffness) = number;
    return true;
  }
  for (std::size_t i = 0; i < kLiveParameters.size(); ++i) {
    if (name != &kLiveParameters[i].option[2] || kLiveParameters[i].zero_is_models) continue;
    own.said.*kLiveFields<LiveOverrides>[i] = number;
    return true;
  }
  return false;
}

}  // namespace

void takeLimit(const std::string& word, ServerConfig& config) {
  std::istringstream text(word);
  std::string name, low, high;
  std::getline(std::getline(std::getline(text, name, '='), low, ':'), high);
  char *low_end = nullptr, *high_end = nullptr;
  const Bounds bounds{std::strtod(low.c_str(), &low_end), std::strtod(high.c_str(), &high_end)};
  if (low.empty() || high.empty() || *low_end != '\0' || *high_end != '\0') refuseLimit(word);
  for (std::size_t i = 0; i < kLiveParameters.size(); ++i)
    if (name == &kLiveParameters[i].option[2]) {
      config.limits.*kLiveFields<LiveBounds>[i] = bounds;
      return;
    }
  if (name != kTipRadius) refuseLimit(word);
  config.tip_limits = bounds;
}

void takeTool(const std::string& word, std::array<OwnOptions, kMaxTools>& all) {
  if (word.size() < 3 || word[1] != ':' || word[0] < '0' || word[0] >= '0' + kMaxTools) refuseTool(word);
  std::istringstream entries(word.substr(2));
  for (std::string entry; std::getline(entries, entry, ',');) {
    const std::size_t equals = entry.find('=');
    if (equals == std::string::npos) refuseTool(word);
    if (!takeOwn(entry.substr(0, equals), entry.substr(equals + 1),
                 all[static_cast<std::size_t>(word[0] - '0')]))
      refuseTool(word);
  }
}

}  // namespace palpate::server
