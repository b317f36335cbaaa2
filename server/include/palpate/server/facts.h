// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

namespace palpate::server {

/// What is settled once the server has started, as ServerStatus tells it.
struct Facts {
  std::string model_id;
  std::uint32_t server_id{0};
  std::uint32_t organ_id{0};
  double rate_hz{0.0};
  double tip_radius{0.0};   ///< m
  double force_limit{0.0};  ///< N
  bool memory_locked{false};
  bool realtime{false};
  std::string realtime_detail;  ///< what was had, or how to get it
};

}  // namespace palpate::server
