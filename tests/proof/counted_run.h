// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>

#include "tick_counts.h"
#include "two_tools.h"

namespace palpate::proof {

/// What the tick thread of a server did while two tools pressed and slid.
struct CountedRun {
  std::string model;
  double seconds{0.0};
  bool memory_locked{false};  ///< else page faults are the system's choice
  bool realtime{false};
  std::int64_t sleeps{0};  ///< of the tick; one a tick
  std::array<std::int64_t, kKinds> calls{};
  std::array<Posts, 4> posts{};
  std::int64_t other_posts{0};
  Usage usage;
  std::array<Answers, 2> tools;
  std::int64_t fields{0};  ///< of the surface that the server made while it was counted
  bool swapped{false};     ///< another organ answered at the end
  std::string log;         ///< the server's

  [[nodiscard]] std::int64_t of(Kind kind) const noexcept { return calls[static_cast<std::size_t>(kind)]; }
  [[nodiscard]] std::int64_t faults() const noexcept { return usage.minor_faults + usage.major_faults; }
};

/// What to run. The environment names the same for a test: PALPATE_COUNTED_SECONDS, PALPATE_COUNTED_MODEL.
struct CountedOptions {
  double seconds{5.0};  ///< that are counted, after one and a half that are not
  std::string model;    ///< a file; empty: the round organ of the tests
  std::string mistake;  ///< of the wrong twin: malloc, lock, fault or sleep; empty: the server as it is
  bool swaps{false};    ///< another organ is asked for while it is counted
};
[[nodiscard]] CountedOptions optionsFromEnvironment();

/// Starts palpate-server in a process of its own, with the counter loaded before its libraries, and two tools.
/// @throw std::runtime_error when nothing was counted, with the server's log
[[nodiscard]] CountedRun countTicks(const CountedOptions& options);

/// What was counted, beside what is allowed, in lines.
[[nodiscard]] std::string table(const CountedRun& run);
/// The same as one JSON object.
[[nodiscard]] std::string json(const CountedRun& run);

}  // namespace palpate::proof
