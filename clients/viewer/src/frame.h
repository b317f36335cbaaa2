// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "palpate/client/surface.h"

namespace palpate::viewer {

using Bytes = std::vector<std::uint8_t>;

/// First number of a binary message: its kind (PROTOCOL.md).
inline constexpr std::uint32_t kMeshKind = 1;
inline constexpr std::uint32_t kFrameKind = 2;

inline constexpr std::size_t kFrameHeaderSize = 56;
inline constexpr std::size_t kToolRecordSize = 72;
inline constexpr std::size_t kAnswerRecordSize = 56;

/// A displacement field as pages get it: 16 bits per number.
struct EncodedField {
  std::uint32_t mesh_revision{0};
  std::uint64_t seq{0};              ///< the server's counter
  double sample_us{0.0};             ///< when the DDS sample came, viewer's monotonic clock, us
  float scale{0.0F};                 ///< m per unit, above 0
  std::vector<std::int16_t> values;  ///< 3 Ns, node-interleaved x y z
};

/// A tool as a page draws it; world frame W, m and N.
struct ToolRecord {
  std::uint32_t tool_id{0};
  std::uint32_t state{0};
  std::uint32_t flags{0};
  bool mine{false};  ///< the receiving page drives it
  std::array<float, 3> tip{};
  std::array<float, 3> proxy{};
  std::array<float, 3> anchor{};
  std::array<float, 3> force{};  ///< on the tool
  float penetration{0.0F};
  float domain_radius{0.0F};
};

inline constexpr float kUnknown = std::numeric_limits<float>::quiet_NaN();

/// One answer of the server, for the strip chart and what is saved of it; world frame W.
struct AnswerRecord {
  std::uint32_t tool_id{0};
  std::uint32_t flags{0};
  double t_us{0.0};                     ///< when the tick woke, viewer's monotonic clock, us
  float force{0.0F};                    ///< size, N
  float penetration{0.0F};              ///< m
  float wakeup_us{0.0F};                ///< lateness of the tick's wake-up
  float stiffness{0.0F};                ///< -n.K n, N/m, along the outward normal n; 0 when free
  std::array<float, 3> force_vector{};  ///< on the tool, N
  std::array<float, 3> tip{kUnknown, kUnknown,
                           kUnknown};  ///< centre of the tip in the newest pose known then, m; NaN: none
};

/// The content of one binary FRAME message.
struct Frame {
  std::uint32_t seq{0};
  std::uint32_t mesh_revision{0};
  const EncodedField* field{nullptr};  ///< nullptr: no surface in this frame
  double sent_us{0.0};
  std::span<const ToolRecord> tools;
  std::span<const AnswerRecord> answers;
};

/// Quantizes a field to 16 bits, in steps of its largest component / 32767.
/// @param[in] displacement  3 Ns, m, finite
[[nodiscard]] EncodedField encodeField(std::span<const float> displacement);

/// Appends a MESH message. @param[in] surface  checked
void encodeMesh(const client::Surface& surface, std::uint32_t revision, Bytes& out);

/// Appends a FRAME message.
void encodeFrame(const Frame& frame, Bytes& out);

}  // namespace palpate::viewer
