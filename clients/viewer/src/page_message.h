// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>
#include <variant>

#include "core/devices/path/path.h"
#include "palpate/live_parameter_list.h"

namespace palpate::viewer {

/// Largest message of a page, bytes.
inline constexpr std::size_t kMaxMessage = 4096;

/// Messages of a page (PROTOCOL.md).
struct Ack {
  std::uint32_t seq;  ///< of the decoded frame
};
struct Ping {
  double t0;  ///< echoed
};
struct Grab {};
struct Release {};
struct Target {
  device::Point
      position;  ///< wanted position of the tip's centre, world W, m; |x|, |y|, |z| <= kMaxCoordinate
};
/// Live parameters that the page wants; `youngs_modulus` is a multiple of the model's E.
struct SetParameters : LiveFields<std::optional<double>> {
  std::uint64_t request;  ///< the page's number for it
};
struct SetRate {
  double hz;  ///< frames wanted, in [0, 1000]
};
using PageMessage = std::variant<Ack, Ping, Grab, Release, Target, SetParameters, SetRate>;

inline constexpr double kMaxCoordinate = 100.0;  ///< m

/// Reads one text message of a page; the page is not trusted.
/// @return nothing unless it is a JSON object of a type above with its fields in range
[[nodiscard]] std::optional<PageMessage> parsePageMessage(std::string_view text);

}  // namespace palpate::viewer
