// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <cstdint>

namespace palpate::faults {

/// What fault_device rendered in one period.
struct Sample {
  std::int64_t at_ns{0};  ///< CLOCK_MONOTONIC, when it was read
  double force{0.0};      ///< its size, N
  double push{0.0};       ///< its part away from the organ, N
  double gain{0.0};
  double age_s{0.0};
  std::uint64_t pose_seq{0};
  std::uint64_t session{0};
};

/// In memory that fault_device writes and the test reads: a minute of samples.
struct Trace {
  std::atomic<std::uint64_t>
      count;  ///< SYNC TRACE: stored with release after the sample, loaded with acquire before
  std::array<Sample, 65536> samples;
};

/// How the device presses: the tip's centre comes from above onto the top of the tests' round organ.
inline constexpr double kTipRadius = 0.005;  ///< m
inline constexpr double kDepth = 0.002;      ///< m

}  // namespace palpate::faults
