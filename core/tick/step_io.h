// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <type_traits>

#include "core/base/max_tools.h"
#include "core/base/status_flags.h"
#include "core/base/types.h"
#include "core/tick/step_config.h"

namespace palpate {

/// What is known about one tool at the start of a tick. Plain: it crosses threads.
struct ToolInput {
  std::uint32_t present{0};          ///< 0: no pose of this tool has come, or the tool is gone
  std::array<double, 3> position{};  ///< p_WT, tip centre in world frame W, m
  std::array<double, 4> orientation{0.0, 0.0, 0.0, 1.0};  ///< q_WT, x y z w
  std::int64_t age_ns{0};  ///< since the pose arrived, by the server's clock, ns
  std::uint32_t flags{0};  ///< what the caller noticed (status_flags.h); copied to the result, else unused
};

/// Input of one tick. Plain: it crosses threads.
struct StepInput {
  std::array<ToolInput, kMaxTools> tools{};
  /// since the last tick, ns; taken as 0 to 0.1 s. A tick advances ramps by at most two periods; after ten periods the contacts'
  /// forces are blended over. So a loop that stood still does not skip a ramp
  std::int64_t dt_ns{1'000'000};
  /// of the loop: how long a force holds until the next one, ns; 0 or less: 1 ms; at most 0.1 s
  std::int64_t period_ns{1'000'000};
  /// not 0: ramp every force to zero within ramp_time and stay there. kHandsOver: no faster than force_rate_limit, flagged
  /// kModelChanging and not kShuttingDown
  std::uint32_t shutting_down{0};
  /// not 0: blend to `settings` within LiveBlend::kSeconds; a tip radius changes when its tool touches nothing. 0: they stay as
  /// they are (at first StepConfig's)
  std::uint32_t has_settings{0};
  /// not 0: the last field that was evaluated was not finite (ShownSurface::overflowed()); flagged, and nothing else
  std::uint32_t field_overflowed{0};
  AllToolSettings settings{};  ///< checked by the caller: firstComplaint() finds nothing
};

/// What one tool gets. Plain: it crosses threads.
struct ToolResult {
  std::uint32_t flags{0};             ///< bits of status_flags.h
  std::uint32_t state{0};             ///< ContactState
  std::array<double, 3> force{};      ///< on the TOOL (-f), W, N
  std::array<double, 9> stiffness{};  ///< d force_i / d position_j as rendered, row-major, N/m
  std::array<double, 3>
      anchor{};  ///< X(s), rest position, m; when free, the nearest point of the rest surface
  std::array<double, 3> proxy{};         ///< X(s) + u(X(s)), m: where a viewer draws the contact
  std::array<double, 3> displacement{};  ///< Response::displacement, m; zero when free
  double domain_radius{0.0};             ///< Response::domain_radius, m; zero when free
  double penetration{0.0};               ///< -d . n as imposed (before clamping), m, >= 0; zero when free
};

/// StepInput::shutting_down where another Workspace answers from then on, of another model.
inline constexpr std::uint32_t kHandsOver = 2;

/// Output of one tick; what the surface is made of is Workspace::surface(). Plain: it crosses threads.
struct StepResult {
  std::array<ToolResult, kMaxTools> tools{};
};

static_assert(std::is_trivially_copyable_v<StepInput> && std::is_trivially_copyable_v<StepResult>);

/// kFlagged: some tool has a flag other than kInContact; its answer is safe but not simply the model's.
enum class StepStatus { kOk, kFlagged };

}  // namespace palpate
