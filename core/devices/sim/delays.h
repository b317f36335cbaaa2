// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

namespace palpate::device {

/// One pose that was sent, as palpate-latency --samples writes it.
struct DelaySample {
  double sent_s{0.0};  ///< since the first pose, s
  std::optional<double>
      answered_s;  ///< when the first force that names it came, on the same clock; nothing: none did
};

/// A file of samples that cannot be used. what() is one line: file, line, what was found.
class DelayError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Measured delays, losses and reordering, period by period of a device at 1 kHz that reads where it sends: in each period the
/// answer acts that came last before it, also where it is that of an older pose than the one before. Where no pose was sent,
/// the driver slept: it neither sends nor reads. Periods in which the newest answer's pose is kStall old or more are left out,
/// and counted: there a server fades the force. What is longer than the measurement goes through it again.
class Delays {
 public:
  static constexpr double kPeriod = 1e-3;    ///< s
  static constexpr std::size_t kStall = 20;  ///< periods: a server's default stale timeout

  struct Period {
    std::uint8_t lag{1};  ///< periods since the pose was sent whose answer acts, in [1, kStall)
    bool sends{true};     ///< a pose goes out
  };

  /// @param[in] samples  in the order of sending  @throw std::invalid_argument  fewer than 100 periods are left
  explicit Delays(std::span<const DelaySample> samples);

  /// Reads what palpate-latency --samples wrote (docs/json.md, palpate-latency); believes nothing. Real-time: no.
  /// @throw DelayError
  [[nodiscard]] static Delays read(const std::filesystem::path& file);

  /// Of a run's period i that begins in period `first` of the measurement. Real-time: yes.
  [[nodiscard]] const Period& at(std::size_t i) const noexcept { return periods_[i % periods_.size()]; }

  [[nodiscard]] std::size_t size() const noexcept { return periods_.size(); }
  [[nodiscard]] double meanLag() const noexcept { return mean_lag_; }             ///< periods
  [[nodiscard]] std::size_t largestLag() const noexcept { return largest_lag_; }  ///< periods
  /// Poses that were sent in a second, Hz; 0: fewer than two.
  [[nodiscard]] double rate() const noexcept { return rate_; }
  /// A line, with its end, where poses were sent more seldom than a device at 1 kHz sends them; else empty.
  [[nodiscard]] std::string note() const;
  [[nodiscard]] std::size_t poses() const noexcept { return poses_; }
  [[nodiscard]] std::size_t lost() const noexcept { return lost_; }  ///< poses without an answer
  [[nodiscard]] std::size_t reordered() const noexcept {
    return reordered_;
  }  ///< answers that came after a newer pose's
  [[nodiscard]] std::size_t stalled() const noexcept { return stalled_; }  ///< periods that are left out
  /// The period at which `length` periods begin whose lags are the largest in the mean.
  [[nodiscard]] std::size_t worstStretch(std::size_t length) const noexcept;

 private:
  std::vector<Period> periods_;
  double mean_lag_{0.0}, rate_{0.0};
  std::size_t largest_lag_{0}, poses_{0}, lost_{0}, reordered_{0}, stalled_{0};
};

}  // namespace palpate::device
