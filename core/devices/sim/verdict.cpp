// SPDX-License-Identifier: Apache-2.0
#include "core/devices/sim/verdict.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace palpate::device {
namespace {

constexpr double kSettling = 0.5;    // s of the hold, and after a stall, that are not judged
constexpr double kHalfMean = 0.125;  // s; half of the running mean's window
constexpr double kFarAway = 10.0;    // m
constexpr double kGrowth = 1.2;
constexpr double kShortest = 0.15;  // s of a stretch that is judged
constexpr double kEnough = 1.0;     // s of all stretches

std::size_t indexAt(const Trace& trace, double t) {
  return static_cast<std::size_t>(std::llround(t / trace.dt));
}

bool isSane(const Trace& trace) {
  return std::all_of(trace.position.begin(), trace.position.end(),
                     [](const Point& p) { return length(p) <= kFarAway; });  // false for NaN
}

Point meanOf(const Trace& trace, std::size_t first, std::size_t last) {
  Point sum{};
  for (std::size_t i = first; i <= last; ++i) sum = sum + trace.position[i];
  return (1.0 / static_cast<double>(last - first + 1)) * sum;
}

// Position less its running mean; a window's sum is moved along.
std::vector<Point> detrended(const Trace& trace, std::size_t first, std::size_t last, std::size_t half) {
  std::vector<Point> about;
  about.reserve(last - first + 1);
  const double weight = 1.0 / static_cast<double>(2 * half + 1);
  Point mean = meanOf(trace, first - half, first + half);
  for (std::size_t i = first; i <= last; ++i) {
    if (i > first) mean = mean + weight * (trace.position[i + half] - trace.position[i - half - 1]);
    about.push_back(trace.position[i] - mean);
  }
  return about;
}

double peakToPeak(const std::vector<Point>& values, std::size_t first, std::size_t last) {
  double largest = 0.0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto [low, high] =
        std::minmax_element(values.begin() + static_cast<std::ptrdiff_t>(first),
                            values.begin() + static_cast<std::ptrdiff_t>(last),
                            [axis](const Point& a, const Point& b) { return a[axis] < b[axis]; });
    largest = std::max(largest, (*high)[axis] - (*low)[axis]);
  }
  return largest;
}

// Entries, both included.
struct Stretch {
  std::size_t first, last;
};

// The parts of the hold between stalls, each from its start on.
std::vector<Stretch> stretchesOf(const Trace& trace, Stretch hold) {
  std::vector<Stretch> stretches{hold};
  for (std::size_t i = hold.first; i <= hold.last && i < trace.stalled.size(); ++i) {
    if (!trace.stalled[i]) continue;
    if (i > hold.first) stretches.back().last = i - 1;
    stretches.push_back({i, hold.last});
  }
  return stretches;
}

// Adds what a stretch shows after it has settled.
void add(const Trace& trace, const Stretch& stretch, Oscillation& sum) {
  const std::size_t half = indexAt(trace, kHalfMean), first = stretch.first + indexAt(trace, kSettling);
  if (stretch.last < first + half + indexAt(trace, kShortest)) return;
  const std::vector<Point> about = detrended(trace, first, stretch.last - half, half);
  const double early = peakToPeak(about, 0, about.size() / 2);
  const double late = peakToPeak(about, about.size() / 2, about.size());
  sum.pp = std::max(sum.pp, peakToPeak(about, 0, about.size()));
  sum.growing = sum.growing || late > kGrowth * early + kNoiseFloor;
  sum.seconds += static_cast<double>(about.size()) * trace.dt;
}

}  // namespace

Oscillation oscillationIn(const Trace& trace, const Motion& motion) {
  const Stretch hold{indexAt(trace, motion.hold_start), indexAt(trace, motion.hold_end)};
  if (trace.position.size() <= hold.last || !isSane(trace)) return {kFarAway, true};
  Oscillation sum;
  for (const Stretch& stretch : stretchesOf(trace, hold)) add(trace, stretch, sum);
  const double most = motion.hold_end - motion.hold_start - kSettling - kHalfMean;
  sum.enough = sum.seconds >= std::min(kEnough, 0.5 * most);
  return sum;
}

std::optional<double> settleTime(const Trace& trace, const Motion& motion) {
  const std::size_t first = indexAt(trace, motion.hold_start);
  const std::size_t end = indexAt(trace, motion.hold_end);
  if (trace.position.size() <= end || !isSane(trace)) return std::nullopt;
  const Point rest = meanOf(trace, end - indexAt(trace, 2.0 * kHalfMean), end);
  const double band = std::max(0.05 * motion.depth, kNoiseFloor);
  std::size_t i = end + 1;
  while (i > first && length(trace.position[i - 1] - rest) <= band) --i;
  if (i > end) return std::nullopt;
  return static_cast<double>(i - first) * trace.dt;
}

Verdict judge(const Trace& with_organ, const Trace& without_organ, const Motion& motion) {
  const Oscillation with = oscillationIn(with_organ, motion);
  const Oscillation without = oscillationIn(without_organ, motion);
  Verdict verdict;
  verdict.judged = with.enough;
  verdict.judged_s = with.seconds;
  verdict.stable = with.enough && !with.growing && with.pp <= 2.0 * without.pp + kNoiseFloor;
  verdict.settle_s = settleTime(with_organ, motion);
  verdict.oscillation_pp = with.pp;
  verdict.oscillation_without_organ_pp = without.pp;
  for (const Point& f : with_organ.force) verdict.max_force = std::max(verdict.max_force, length(f));
  for (const Point& p : with_organ.position)
    verdict.depth = std::max(verdict.depth, motion.tip_radius - dot(p - motion.surface, motion.normal));
  return verdict;
}

}  // namespace palpate::device
