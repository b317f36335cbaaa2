// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <type_traits>

#include "core/data/sha256.h"
#include "core/record/engine_version.h"
#include "core/tick/step.h"

namespace palpate::record {

/// A recording that cannot be written or read. what() is one line: file, where in it, what was found.
class RecordError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A recording whose end is missing: its server was killed, or the file was cut.
class TruncatedError : public RecordError {
 public:
  using RecordError::RecordError;
};

/// The newest pose of a tool that a tick knew, as it came: what step() does not need, and playing it back does.
struct PoseFacts {
  std::uint64_t seq{0};        ///< sender's counter
  std::int64_t stamp_ns{0};    ///< sender's clock; 0: not valid
  std::int64_t arrival_ns{0};  ///< server's monotonic clock; 0: no pose has come
  std::uint32_t buttons{0};    ///< bit i: button i is held down

  [[nodiscard]] bool operator==(const PoseFacts&) const noexcept = default;
};

/// What went into one tick's step() and what came out. Plain: it crosses threads.
struct RecordedTick {
  std::uint64_t index{0};  ///< ticks run before this one
  StepInput input;
  StepResult result;
  std::int64_t woke_ns{0};  ///< server's monotonic clock when the tick woke
  std::array<PoseFacts, kMaxTools> poses{};
};

static_assert(std::is_trivially_copyable_v<RecordedTick>);

/// What a session ran on. The state before tick 0 is that of a new Workspace.
struct SessionFacts {
  Digest model;                ///< of the content that the session ran on
  std::int64_t started_ns{0};  ///< wall clock, since 1970, ns; for people only
  StepConfig config;
  EngineVersion engine{thisEngine()};
};

/// How a recording ends.
struct SessionEnd {
  std::uint64_t ticks{0};    ///< in the file
  std::uint64_t missing{0};  ///< ticks that were run and are not in the file
};

}  // namespace palpate::record
