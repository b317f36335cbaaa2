// SPDX-License-Identifier: Apache-2.0
#include "core/record/tick_codec.h"

#include <string>

#include "core/record/recorded_fields.h"

namespace palpate::record {
namespace {

// What follows for a tick,
constexpr std::uint8_t kPeriod = 1;    // period_ns: it changed
constexpr std::uint8_t kShutting = 2;  // shutting_down: it changed
constexpr std::uint8_t kSettings = 4;  // has_settings, and the settings of all tools
constexpr std::uint8_t kOverflow = 8;  // field_overflowed is 1
constexpr std::uint8_t kWoke = 16;     // woke_ns: it is not dt_ns after that of the record before
constexpr std::uint8_t kTickBits = 31;
// and for a tool of it.
constexpr std::uint8_t kInput = 1;   // there is a tool: present, age_ns, flags; without, ToolInput{}
constexpr std::uint8_t kPose = 2;    // position and orientation: they changed
constexpr std::uint8_t kResult = 4;  // all fields of the result: one changed
constexpr std::uint8_t kFacts = 8;   // seq, stamp_ns, arrival_ns, buttons: they changed
constexpr std::uint8_t kToolBits = 15;

// Bit for bit: -0.0 is not 0.0, and a NaN is itself.
template <class T>
bool sameBits(const T& a, const T& b) {
  return std::memcmp(&a, &b, sizeof(T)) == 0;
}

bool samePose(const ToolInput& a, const ToolInput& b) {
  return sameBits(a.position, b.position) && sameBits(a.orientation, b.orientation);
}

Bytes bytesOf(const ToolResult& result) {
  Bytes bytes;
  forEachResultField(result, [&](const char*, const auto& field) { put(bytes, field); });
  return bytes;
}

// Wraps, since a file may hold any numbers.
std::int64_t sum(std::int64_t a, std::int64_t b) {
  return static_cast<std::int64_t>(static_cast<std::uint64_t>(a) + static_cast<std::uint64_t>(b));
}

void refuseUnknown(std::uint8_t bits, std::uint8_t known, const char* what) {
  if ((bits & ~known) != 0)
    throw RecordError("a record's " + std::string(what) + " has unknown bits " + std::to_string(bits));
}

}  // namespace

void TickCodec::encode(const RecordedTick& tick, Bytes& out) {
  const StepInput& input = tick.input;
  std::uint8_t bits = 0;
  if (input.period_ns != last_.input.period_ns) bits |= kPeriod;
  if (input.shutting_down != last_.input.shutting_down) bits |= kShutting;
  if (input.has_settings != 0) bits |= kSettings;
  if (input.field_overflowed != 0) bits |= kOverflow;
  if (tick.woke_ns != sum(last_.woke_ns, input.dt_ns)) bits |= kWoke;
  put(out, tick.index);
  put(out, input.dt_ns);
  put(out, bits);
  if ((bits & kWoke) != 0) put(out, tick.woke_ns);
  if ((bits & kPeriod) != 0) put(out, input.period_ns);
  if ((bits & kShutting) != 0) put(out, input.shutting_down);
  if ((bits & kSettings) != 0) {
    put(out, input.has_settings);
    forEachSetting(input.settings, [&](const char*, const double& field) { put(out, field); });
  }
  for (std::size_t tool = 0; tool < input.tools.size(); ++tool) encodeTool(tick, tool, out);
  last_.woke_ns = tick.woke_ns;
  last_.input.period_ns = input.period_ns;
  last_.input.shutting_down = input.shutting_down;
}

void TickCodec::encodeTool(const RecordedTick& tick, std::size_t tool, Bytes& out) {
  const ToolInput& input = tick.input.tools[tool];
  const ToolResult& result = tick.result.tools[tool];
  const PoseFacts& facts = tick.poses[tool];
  const bool there = input.present != 0 || input.flags != 0;
  ToolInput& known = last_.input.tools[tool];  // what the reader has by now
  const Bytes result_bytes = bytesOf(result);
  std::uint8_t bits = 0;
  if (there) bits |= kInput;
  if (there && !samePose(input, known)) bits |= kPose;
  if (result_bytes != bytesOf(last_.result.tools[tool])) bits |= kResult;
  if (facts != last_.poses[tool]) bits |= kFacts;
  put(out, bits);
  if (there) {
    put(out, input.present);
    put(out, input.age_ns);
    put(out, input.flags);
  }
  if ((bits & kPose) != 0) {
    put(out, input.position);
    put(out, input.orientation);
    known = input;
  }
  if ((bits & kResult) != 0) putBytes(out, result_bytes.data(), result_bytes.size());
  if ((bits & kFacts) != 0) forEachFact(facts, [&](const auto& field) { put(out, field); });
  last_.result.tools[tool] = result;
  last_.poses[tool] = facts;
}

void TickCodec::decode(ByteSource& in, RecordedTick& tick) {
  StepInput& input = last_.input;
  in.get(last_.index);
  in.get(input.dt_ns);
  const auto bits = in.get<std::uint8_t>();
  refuseUnknown(bits, kTickBits, "tick");
  last_.woke_ns = sum(last_.woke_ns, input.dt_ns);
  if ((bits & kWoke) != 0) in.get(last_.woke_ns);
  if ((bits & kPeriod) != 0) in.get(input.period_ns);
  if ((bits & kShutting) != 0) in.get(input.shutting_down);
  input.field_overflowed = (bits & kOverflow) != 0 ? 1 : 0;
  input.has_settings = 0;
  if ((bits & kSettings) != 0) {
    in.get(input.has_settings);
    forEachSetting(input.settings, [&](const char*, double& field) { in.get(field); });
  }
  for (std::size_t tool = 0; tool < input.tools.size(); ++tool) decodeTool(in, tool);
  tick = last_;
}

void TickCodec::decodeTool(ByteSource& in, std::size_t tool) {
  ToolInput& input = last_.input.tools[tool];
  const auto bits = in.get<std::uint8_t>();
  refuseUnknown(bits, kToolBits, "tool");
  input.present = 0;
  input.age_ns = 0;
  input.flags = 0;
  if ((bits & kInput) != 0) {
    in.get(input.present);
    in.get(input.age_ns);
    in.get(input.flags);
  }
  if ((bits & kPose) != 0) {
    in.get(input.position);
    in.get(input.orientation);
  }
  if ((bits & kResult) != 0)
    forEachResultField(last_.result.tools[tool], [&](const char*, auto& field) { in.get(field); });
  if ((bits & kFacts) != 0) forEachFact(last_.poses[tool], [&](auto& field) { in.get(field); });
}

}  // namespace palpate::record
