// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>
#include <variant>

#include "palpate/client/path.h"

namespace palpate::viewer {

/// The largest message that a page may send, bytes.
inline constexpr std::size_t kMaxMessage = 4096;

/// What a page says (PROTOCOL.md).
struct Ack {
  std::uint32_t seq;  ///< of the frame that was decoded
};
struct Ping {
  double t0;  ///< echoed
};
struct Grab {};
struct Release {};
struct Target {
  client::Point position;  ///< where the tip's centre is to be, world W, m; |x|, |y|, |z| <= kMaxCoordinate
};
struct SetParameters {
  std::uint64_t request;                ///< the page's number of it
  std::optional<double> youngs_factor;  ///< of the model's E
  std::optional<double> friction;
  std::optional<double> coupling_stiffness;  ///< N/m
  std::optional<double> coupling_damping;    ///< N s/m
  std::optional<double> force_limit;         ///< N
  std::optional<double> force_rate_limit;    ///< N/s
};
struct SetRate {
  double hz;  ///< frames wanted, in [0, 1000]
};
using PageMessage = std::variant<Ack, Ping, Grab, Release, Target, SetParameters, SetRate>;

inline constexpr double kMaxCoordinate = 100.0;  ///< m

/// Reads one text message of a page, which is not trusted.
/// @return nothing when it is no JSON object of a type above with its fields in range
[[nodiscard]] std::optional<PageMessage> parsePageMessage(std::string_view text);

}  // namespace palpate::viewer
