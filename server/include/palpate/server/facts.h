// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "core/tick/coupling_choice.h"
#include "palpate/server/config.h"

namespace palpate {
class MetaModel;
}

namespace palpate::server {

/// What no longer changes once the server has started, as ServerStatus reports it. But for what is the model's, which another model
/// changes: model_id, model_hash, organ and memory_locked are the events thread's.
struct Facts {
  std::uint32_t server_id{0};
  std::uint64_t session{0};  ///< random, of this run; never 0
  bool answers_any{true};    ///< also poses that name no server
  std::string host;
  std::uint32_t pid{0};
  std::string model_id;
  std::uint64_t model_hash{0};  ///< of the model's content
  std::uint32_t organ_id{0};
  double rate_hz{0.0};
  std::array<std::string, kMaxTools> device;  ///< by tool: preset or custom
  StepConfig step;                            ///< as started, with the first organ's stiffness
  OrganStiffness organ{};                     ///< the model's own
  bool parameters{true};                      ///< requests may change live parameters
  LiveBounds limits;                          ///< within these
  std::optional<Bounds> tip_limits;           ///< ServerConfig::tip_limits
  bool process_locked{false};                 ///< all but models: what is there and what comes
  bool memory_locked{false};                  ///< and the model that answers
  bool realtime{false};
  std::string realtime_detail;  ///< what was obtained, or how to get it
};

/// What is known before the start: a new session, this process, the model, the configuration. Cost that of
/// largestStiffness(). Real-time: no.
[[nodiscard]] Facts factsOf(const MetaModel& model, const ServerConfig& config);

}  // namespace palpate::server
