// SPDX-License-Identifier: Apache-2.0
#include "rare_warning.h"

#include <spdlog/spdlog.h>

#include "palpate/rt/clock.h"

namespace palpate::viewer {

void warnRarely(std::string_view text) {
  static std::int64_t next_ns = 0;
  const std::int64_t now_ns = rt::monotonicNow();
  if (now_ns < next_ns) return;
  next_ns = now_ns + 1'000'000'000;
  spdlog::warn("{}", text);
}

}  // namespace palpate::viewer
