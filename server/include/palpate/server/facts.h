// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

#include "palpate/core/step_config.h"

namespace palpate::server {

/// What no longer changes once the server has started, as ServerStatus reports it.
struct Facts {
  std::string model_id;
  std::uint32_t server_id{0};
  std::uint32_t organ_id{0};
  double rate_hz{0.0};
  std::string device;          ///< preset or custom
  StepConfig step;             ///< as started
  double youngs_modulus{0.0};  ///< the model's own, Pa
  bool memory_locked{false};
  bool realtime{false};
  std::string realtime_detail;  ///< what was obtained, or how to get it
};

}  // namespace palpate::server
