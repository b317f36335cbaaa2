// SPDX-License-Identifier: Apache-2.0
#include "tools/examine/replay/replay.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "core/record/recorded_fields.h"
#include "core/tick/step_io.h"
#include "core/tick/workspace.h"

namespace palpate::replay {
namespace {

using record::RecordError;

template <class T, class Visit>
void forEachNumber(const char* name, const T& number, Visit&& visit) {
  visit(std::string(name), number);
}
template <class T, std::size_t N, class Visit>
void forEachNumber(const char* name, const std::array<T, N>& numbers, Visit&& visit) {
  for (std::size_t i = 0; i < N; ++i) visit(std::string(name) + "[" + std::to_string(i) + "]", numbers[i]);
}

// A result's numbers one after the other, with their names.
template <class Visit>
void forEachNumber(const ToolResult& result, Visit&& visit) {
  record::forEachResultField(result,
                             [&](const char* name, const auto& field) { forEachNumber(name, field, visit); });
}

bool sameBits(const ToolResult& a, const ToolResult& b) {
  // Fields lie without a gap in between, so that the object's bytes are the fields' bytes.
  static_assert(sizeof(ToolResult) == 2 * sizeof(std::uint32_t) + 23 * sizeof(double));
  return std::memcmp(&a, &b, sizeof(ToolResult)) == 0;
}

// The first of a tool's numbers that differ.
Difference between(const ToolResult& recorded, const ToolResult& replayed) {
  struct Number {
    std::string name;
    double value;
    std::uint64_t bits;
  };
  const auto numbersOf = [](const ToolResult& result) {
    std::vector<Number> numbers;
    forEachNumber(result, [&](std::string name, auto value) {
      Number number{std::move(name), static_cast<double>(value), 0};
      std::memcpy(&number.bits, &value, sizeof value);
      numbers.push_back(std::move(number));
    });
    return numbers;
  };
  const std::vector<Number> left = numbersOf(recorded);
  const std::vector<Number> right = numbersOf(replayed);
  std::size_t i = 0;
  while (i + 1 < left.size() && left[i].bits == right[i].bits) ++i;
  Difference difference;
  difference.field = left[i].name;
  difference.recorded = left[i].value;
  difference.replayed = right[i].value;
  return difference;
}

void compare(const record::RecordedTick& tick, const StepResult& replayed, Findings& findings) {
  bool differs = false;
  for (std::size_t tool = 0; tool < replayed.tools.size(); ++tool) {
    const ToolResult& recorded = tick.result.tools[tool];
    findings.largest_force =
        std::max(findings.largest_force, std::hypot(recorded.force[0], recorded.force[1], recorded.force[2]));
    if (sameBits(recorded, replayed.tools[tool])) continue;
    differs = true;
    if (findings.first) continue;
    findings.first = between(recorded, replayed.tools[tool]);
    findings.first->tick = tick.index;
    findings.first->tool = tool;
  }
  findings.differing += differs ? 1 : 0;
}

// A recording is a file like any other: what the server refuses on the wire is no input here either.
void requireFit(const record::SessionFacts& facts, const MetaModel& model) {
  if (facts.model != model.digest())
    throw RecordError("recorded with model " + facts.model.id() + ", replayed with model " + model.id() +
                      ": their contents differ");
  if (const auto complaint = firstComplaint(facts.config))
    throw RecordError("the recording's header: " + complaint->sentence());
}

void noteEngine(const record::SessionFacts& facts, Demand demand, Findings& findings) {
  findings.other_engine = !(facts.engine == record::thisEngine());
  if (findings.other_engine && demand == Demand::kWhole)
    throw RecordError("recorded with engine " + facts.engine.text() + ", this is engine " +
                      record::thisEngine().text() +
                      ": the bits need not be the same (--partial replays all the same)");
}

void requireRange(const record::RecordedTick& tick) {
  if (tick.input.has_settings == 0) return;
  for (std::size_t tool = 0; tool < tick.input.settings.size(); ++tool)
    if (const auto complaint = firstComplaint(tick.input.settings[tool]))
      throw RecordError("tick " + std::to_string(tick.index) + ": tool " + std::to_string(tool) + ": " +
                        complaint->sentence());
  const auto modulus = [&](std::size_t tool) { return tick.input.settings[tool].live.youngs_modulus; };
  for (std::size_t tool = 1; tool < tick.input.settings.size(); ++tool)
    if (modulus(tool) != modulus(0))
      throw RecordError("tick " + std::to_string(tick.index) + ": tool " + std::to_string(tool) +
                        ": youngs_modulus is " + std::to_string(modulus(tool)) +
                        ", expected that of tool 0, " + std::to_string(modulus(0)) + ": it is the organ's");
}

}  // namespace

bool nextTick(record::RecordReader& recording, Demand demand, record::RecordedTick& tick, bool& truncated) {
  try {
    return recording.next(tick);
  } catch (const record::TruncatedError&) {
    if (demand == Demand::kWhole) throw;
    truncated = true;
    return false;
  }
}

void noteGap(std::uint64_t expected, std::uint64_t found, Demand demand, std::uint64_t& missing) {
  if (found == expected) return;
  if (demand == Demand::kWhole)
    throw RecordError("ticks " + std::to_string(expected) + " to " + std::to_string(found - 1) +
                      " are missing: without them the state is not known (--partial takes what is there)");
  missing += found - expected;
}

void noteEnd(const record::RecordReader& recording, Demand demand, bool truncated, std::uint64_t& missing) {
  if (truncated || recording.end().missing <= missing) return;
  if (demand == Demand::kWhole)
    throw RecordError(std::to_string(recording.end().missing) +
                      " ticks are missing (--partial takes what is there)");
  missing = recording.end().missing;
}

Findings replay(record::RecordReader& recording, const MetaModel& model, Demand demand) {
  // 1. The same model and parameters, and a new state.
  const record::SessionFacts& facts = recording.facts();
  requireFit(facts, model);
  Findings findings;
  noteEngine(facts, demand, findings);
  Workspace work(model, facts.config);
  // 2. Tick by tick.
  StepResult result;
  record::RecordedTick tick;
  std::uint64_t expected = 0;
  while (nextTick(recording, demand, tick, findings.truncated)) {
    noteGap(expected, tick.index, demand, findings.missing);
    expected = tick.index + 1;
    requireRange(tick);
    (void)step(model, work, tick.input, result);
    compare(tick, result, findings);
    ++findings.ticks;
    findings.seconds += 1e-9 * static_cast<double>(tick.input.dt_ns);
  }
  if (findings.ticks == 0) throw RecordError("the recording holds no ticks: there is nothing to compare");
  // 3. Ticks missing at the end show in nothing else.
  noteEnd(recording, demand, findings.truncated, findings.missing);
  return findings;
}

}  // namespace palpate::replay
