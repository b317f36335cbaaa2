// SPDX-License-Identifier: Apache-2.0
#include "frame.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

namespace palpate::viewer {
namespace {

static_assert(std::endian::native == std::endian::little, "the wire is little-endian, numbers are copied");

template <class T>
void put(Bytes& out, const T* values, std::size_t count) {
  const std::size_t at = out.size();
  out.resize(at + count * sizeof(T));
  if (count > 0) std::memcpy(out.data() + at, values, count * sizeof(T));
}

template <class T>
void put(Bytes& out, T value) {
  put(out, &value, 1);
}

void pad(Bytes& out, std::size_t from) {
  while ((out.size() - from) % 4 != 0) out.push_back(0);
}

void putTool(const ToolRecord& tool, Bytes& out) {
  for (const std::uint32_t number : {tool.tool_id, tool.state, tool.flags, tool.mine ? 1U : 0U})
    put(out, number);
  for (const auto& vector : {tool.tip, tool.proxy, tool.anchor, tool.force}) put(out, vector.data(), 3);
  put(out, tool.penetration);
  put(out, tool.domain_radius);
}

void putAnswer(const AnswerRecord& answer, Bytes& out) {
  put(out, answer.tool_id);
  put(out, answer.flags);
  put(out, answer.t_us);
  for (const float number : {answer.force, answer.penetration, answer.wakeup_us, answer.stiffness})
    put(out, number);
  put(out, answer.force_vector.data(), 3);
  put(out, answer.tip.data(), 3);
}

void putHeader(const Frame& frame, Bytes& out) {
  const EncodedField* field = frame.field;
  put(out, kFrameKind);
  put(out, frame.seq);
  put(out, frame.mesh_revision);
  put(out, static_cast<std::uint32_t>(field ? field->values.size() / 3 : 0));
  put(out, field ? field->sample_us : 0.0);
  put(out, frame.sent_us);
  put(out, field ? field->seq : std::uint64_t{0});
  put(out, static_cast<std::uint32_t>(frame.tools.size()));
  put(out, static_cast<std::uint32_t>(frame.answers.size()));
  put(out, field ? field->scale : 0.0F);
  put(out, std::uint32_t{0});
}

/// @param of  a surface, or that of a region
template <class T>
void putSizes(const T& of, Bytes& out) {
  put(out, static_cast<std::uint32_t>(of.positions.size()));
  put(out, static_cast<std::uint32_t>(of.triangles.size()));
}

template <class T>
void putShape(const T& of, Bytes& out) {
  for (const device::Point& X : of.positions)
    for (const double x : X) put(out, static_cast<float>(x));
  for (const auto& triangle : of.triangles) put(out, triangle.data(), 3);
}

}  // namespace

EncodedField encodeField(std::span<const float> displacement) {
  constexpr float kUnits = 32767.0F;
  constexpr float kLeastScale = 1e-12F;  // m; scale of a field of zeros
  float largest = 0.0F;
  for (const float u : displacement) largest = std::max(largest, std::fabs(u));
  EncodedField field;
  field.scale = std::max(largest / kUnits, kLeastScale);
  field.values.resize(displacement.size());
  std::transform(displacement.begin(), displacement.end(), field.values.begin(), [&](float u) {
    return static_cast<std::int16_t>(std::clamp(std::round(u / field.scale), -kUnits, kUnits));
  });
  return field;
}

void encodeMesh(const client::Surface& surface, std::uint32_t revision, Bytes& out) {
  const std::size_t start = out.size();
  put(out, kMeshKind);
  putSizes(surface, out);
  put(out, revision);
  put(out, static_cast<std::uint32_t>(surface.regions.size()));
  putShape(surface, out);
  put(out, surface.accessible.data(), surface.accessible.size());
  put(out, surface.clamped.data(), surface.clamped.size());
  pad(out, start);
  for (const client::Region& region : surface.regions) {
    putSizes(region, out);
    putShape(region, out);
  }
}

void encodeFrame(const Frame& frame, Bytes& out) {
  const std::size_t start = out.size();
  putHeader(frame, out);
  if (frame.field) put(out, frame.field->values.data(), frame.field->values.size());
  pad(out, start);
  for (const ToolRecord& tool : frame.tools) putTool(tool, out);
  for (const AnswerRecord& answer : frame.answers) putAnswer(answer, out);
}

}  // namespace palpate::viewer
