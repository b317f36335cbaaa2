// SPDX-License-Identifier: Apache-2.0
// Hours of server time in minutes: the server's tick without its thread and without DDS, by a clock that only counts.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "core/model/meta_model.h"

namespace palpate::proof {

/// A session: all tools come from above, press and slide in turn, two at once, and lift off; friction changes.
inline constexpr std::uint64_t kSessionTicks = 8000;

struct SimulatedOptions {
  std::uint64_t sessions{450};        ///< of 8 s at 1 kHz; the second is what all later ones are held against
  std::uint64_t sessions_a_row{450};  ///< an hour
  std::uint64_t nudged_session{
      0};  ///< for the tests: in this session tool 0 presses 1e-12 m less deep; 0: in none
  std::uint64_t leaking_session{
      0};  ///< for the tests: from this session on each tick allocates; 0: from none
};

/// What went on in the sessions of one row. All but `ticks` and sizes are 0 where all is well.
struct SimulatedRow {
  std::uint64_t ticks{0};
  std::uint64_t in_contact{0};     ///< answers
  double largest_force{0.0};       ///< N
  std::uint64_t not_finite{0};     ///< answers and fields
  std::uint64_t beyond_limit{0};   ///< answers above the force limit
  std::uint64_t differing{0};      ///< answers with other bits than at the same place of the second session
  double largest_difference{0.0};  ///< of their forces, N
  std::uint64_t out_of_step{
      0};  ///< answers whose numbers, echoes or stamps are not the next ones, or ticks so counted
  std::uint64_t faults{0};       ///< answers with a flag that tools that behave do not get
  std::uint64_t cut_short{0};    ///< answers whose search was cut short: no fault
  std::uint64_t lost{0};         ///< records that found no room, poses that no tick saw
  std::uint64_t allocations{0};  ///< and frees in these ticks
  double resident_MiB{0.0};      ///< of this process, at its end
  double seconds{0.0};           ///< that it took

  /// Whether nothing of that is wrong.
  [[nodiscard]] bool holds() const noexcept {
    return not_finite + beyond_limit + differing + out_of_step + faults + lost + allocations == 0;
  }
};

/// Runs the tick on a model as palpate-server would by default. Four tools, at accessible places far from each other. Time, tick
/// and pose numbers begin so that within the run they pass 2^53 ns and 2^32, where a double or a shorter counter would lose.
/// @param[in] told  called with each row. @throw std::invalid_argument  the organ has fewer than four places
std::vector<SimulatedRow> simulateHours(const std::shared_ptr<const MetaModel>& model,
                                        const SimulatedOptions& options,
                                        const std::function<void(const SimulatedRow&)>& told = {});

}  // namespace palpate::proof
