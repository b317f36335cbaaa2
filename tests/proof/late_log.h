// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace palpate::proof {

/// A late tick as the server's log tells it (SPDLOG_LEVEL=debug). Times in us, by the server's CLOCK_MONOTONIC.
struct ToldTick {
  std::int64_t due_us{0};
  std::int64_t late_us{0};
  std::string cause;  ///< "preempted by cpu-hog (7), FIFO 90"
};

/// What made a tick late, and for how long by itself.
struct Injection {
  std::int64_t at_us{0};
  std::int64_t for_us{0};
};

[[nodiscard]] std::vector<ToldTick> toldTicks(const std::string& log);
/// Those of the library late_injector.
[[nodiscard]] std::vector<Injection> injections(const std::string& log);

/// How injections were named.
struct Named {
  int clear{
      0};  ///< the injection makes at least half of what its tick was late, so that it is the cause; or no tick is told
  int right{0};         ///< of these
  std::string wrongly;  ///< a line for each other one
};

/// The late tick of each injection, by time. @param[in] cause  how the right one begins
[[nodiscard]] Named compare(const std::vector<Injection>& injected, const std::vector<ToldTick>& told,
                            std::string_view cause);

}  // namespace palpate::proof
