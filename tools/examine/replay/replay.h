// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "core/model/meta_model.h"
#include "core/record/record_reader.h"

namespace palpate::replay {

/// Where a replay first gave other bits than the session.
struct Difference {
  std::uint64_t tick{0};
  std::size_t tool{0};
  std::string field;  ///< of ToolResult, with its index: "force[2]"
  double recorded{0.0};
  double replayed{0.0};
};

/// What a replay found.
struct Findings {
  std::uint64_t ticks{0};      ///< replayed
  std::uint64_t missing{0};    ///< ticks that the session ran and the file does not hold, as far as it tells
  std::uint64_t differing{0};  ///< ticks with any other bit
  double seconds{0.0};         ///< of the session, the sum of its ticks' dt
  double largest_force{0.0};   ///< N, as recorded
  std::optional<Difference> first;
  bool truncated{false};     ///< the file has no end
  bool other_engine{false};  ///< another version gave the recorded answers
};

/// What a recording must be.
enum class Demand {
  kWhole,   ///< every tick from the first on, and an end, of this engine's version
  kPartial  ///< any part of it, of any engine; after a gap, or of another engine, differences are expected
};

/// The next tick. @return false at the end, or where the file ends early if that is allowed  @throw record::RecordError
[[nodiscard]] bool nextTick(record::RecordReader& recording, Demand demand, record::RecordedTick& tick,
                            bool& truncated);
/// Counts the ticks that are missing before one that was found, or refuses them. @throw record::RecordError
void noteGap(std::uint64_t expected, std::uint64_t found, Demand demand, std::uint64_t& missing);
/// The same of what the end tells of, once nextTick() returned false. @throw record::RecordError
void noteEnd(const record::RecordReader& recording, Demand demand, bool truncated, std::uint64_t& missing);

/// Runs a session's inputs through step() again, from a new Workspace, without threads or clocks, and compares each
/// result with the recorded one bit for bit, field by field.
/// @throw record::RecordError  damaged; another model; under kWhole also another engine, a missing tick or a missing end
/// Real-time: no.
[[nodiscard]] Findings replay(record::RecordReader& recording, const MetaModel& model, Demand demand);

}  // namespace palpate::replay
