// SPDX-License-Identifier: Apache-2.0
#include "core/devices/sim/delays.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <string>
#include <string_view>

namespace palpate::device {
namespace {

constexpr std::size_t kFewest = 100;  // periods
constexpr std::size_t kMostSamples = 10'000'000;
constexpr double kLongest = 86400.0;  // s
constexpr std::string_view kHeader = "seq,sent_s,answered_s,lost";

// Where most poses lie within a period: the circular mean.
double phaseOf(std::span<const DelaySample> samples) {
  constexpr double kTurn = 2.0 * M_PI / Delays::kPeriod;
  double x = 0.0, y = 0.0;
  for (const DelaySample& sample : samples) {
    x += std::cos(kTurn * sample.sent_s);
    y += std::sin(kTurn * sample.sent_s);
  }
  return std::atan2(y, x) / kTurn;
}

// The period of each sample, from 0.
std::vector<std::size_t> periodsOf(std::span<const DelaySample> samples) {
  const double phase = phaseOf(samples);
  std::vector<std::size_t> periods;
  periods.reserve(samples.size());
  const auto of = [&](double t) { return std::llround((t - phase) / Delays::kPeriod); };
  const auto first = of(samples.front().sent_s);
  for (const DelaySample& sample : samples)
    periods.push_back(static_cast<std::size_t>(of(sample.sent_s) - first));
  return periods;
}

// Indices of the answered samples in the order in which the answers came.
std::vector<std::size_t> arrivalsOf(std::span<const DelaySample> samples) {
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < samples.size(); ++i)
    if (samples[i].answered_s) order.push_back(i);
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return *samples[a].answered_s < *samples[b].answered_s;
  });
  return order;
}

/// Lines of a file of samples, and where it is wrong.
class SampleFile {
 public:
  explicit SampleFile(const std::filesystem::path& path) : path_(path), file_(path) {
    if (!std::filesystem::is_regular_file(path) || !file_)
      throw DelayError(path.string() + ": cannot be read as a file");
    if (!next() || line_ != kHeader)
      refuse("expected the line " + std::string(kHeader) + " of palpate-latency --samples");
  }

  std::vector<DelaySample> samples() {
    std::vector<DelaySample> samples;
    std::uint64_t last_seq = 0;
    while (next()) {
      std::string_view rest = line_;
      const std::string_view seq_text = cell(rest), sent = cell(rest), answered = cell(rest),
                             lost = cell(rest);
      const auto seq = number<std::uint64_t>("seq", seq_text);
      if (!samples.empty() && seq <= last_seq)
        refuse("seq is " + std::to_string(seq) + " after " + std::to_string(last_seq));
      last_seq = seq;
      samples.push_back(sampleOf(sent, answered, lost));
      if (samples.size() > 1 && samples.back().sent_s < samples[samples.size() - 2].sent_s)
        refuse("sent_s is " + std::string(sent) + ", before that of the pose before");
      if (samples.size() > kMostSamples) refuse("more than " + std::to_string(kMostSamples) + " poses");
    }
    if (file_.bad()) refuse("cannot be read");
    return samples;
  }

 private:
  bool next() {
    constexpr std::size_t kLongestLine = 200;
    if (!std::getline(file_, line_)) return false;
    ++number_;
    if (!line_.empty() && line_.back() == '\r') line_.pop_back();
    if (line_.size() > kLongestLine) refuse("is " + std::to_string(line_.size()) + " characters long");
    return true;
  }

  [[nodiscard]] std::string_view cell(std::string_view& rest) const {
    const std::size_t end = rest.find(',');
    const std::string_view text = rest.substr(0, end);
    rest = end == std::string_view::npos ? std::string_view() : rest.substr(end + 1);
    return text;
  }

  [[nodiscard]] DelaySample sampleOf(std::string_view sent, std::string_view answered,
                                     std::string_view lost) const {
    DelaySample sample{time("sent_s", sent), std::nullopt};
    if (lost != "0" && lost != "1") refuse("lost is '" + std::string(lost) + "', expected 0 or 1");
    if ((lost == "1") != answered.empty()) refuse("answered_s is empty where, and only where, lost is 1");
    if (answered.empty()) return sample;
    sample.answered_s = time("answered_s", answered);
    if (*sample.answered_s < sample.sent_s)
      refuse("answered_s is " + std::string(answered) + ", before the pose was sent");
    return sample;
  }

  [[nodiscard]] double time(const char* name, std::string_view text) const {
    const auto value = number<double>(name, text);
    if (!(value >= 0.0 && value <= kLongest))
      refuse(std::string(name) + " is " + std::string(text) + ", expected 0 to 86400 s");
    return value;
  }

  template <class T>
  [[nodiscard]] T number(const char* name, std::string_view text) const {
    T value{};
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size())
      refuse(std::string(name) + " is '" + std::string(text) + "', expected a number");
    return value;
  }

  [[noreturn]] void refuse(const std::string& text) const {
    throw DelayError(path_.string() + ":" + std::to_string(std::max<std::size_t>(number_, 1)) + ": " + text);
  }

  std::filesystem::path path_;
  std::ifstream file_;
  std::string line_;
  std::size_t number_{0};
};

}  // namespace

Delays::Delays(std::span<const DelaySample> samples) {
  if (samples.empty()) throw std::invalid_argument("there are no poses");
  // 1. When poses went out, and in which order answers came.
  const std::vector<std::size_t> period = periodsOf(samples);
  const std::vector<std::size_t> arrivals = arrivalsOf(samples);
  poses_ = samples.size();
  lost_ = samples.size() - arrivals.size();
  const double seconds = samples.back().sent_s - samples.front().sent_s;
  if (seconds > 0.0) rate_ = static_cast<double>(samples.size() - 1) / seconds;
  for (std::size_t i = 1, newest = 0; i < arrivals.size(); ++i) {
    newest = std::max(newest, arrivals[i - 1]);
    reordered_ += arrivals[i] < newest ? 1 : 0;
  }
  // 2. Period by period: the driver wakes with its first pose of the period, and takes what came last.
  std::size_t next = 0, sample = 0;
  std::optional<std::size_t> acts;  // period of the pose whose answer acts
  double lags = 0.0;
  for (std::size_t i = 0; i <= period.back(); ++i) {
    const bool sends = period[sample] == i;
    for (; sends && next < arrivals.size() && *samples[arrivals[next]].answered_s <= samples[sample].sent_s;
         ++next)
      acts = period[arrivals[next]];
    while (sample + 1 < period.size() && period[sample] <= i) ++sample;
    if (!acts) continue;
    const std::size_t lag = std::max<std::size_t>(1, i - *acts);
    if (lag >= kStall) {
      ++stalled_;
      continue;
    }
    periods_.push_back({static_cast<std::uint8_t>(lag), sends});
    lags += static_cast<double>(lag);
    largest_lag_ = std::max(largest_lag_, lag);
  }
  if (periods_.size() < kFewest)
    throw std::invalid_argument(std::to_string(periods_.size()) +
                                " periods of 1 ms with an answer, expected at least " +
                                std::to_string(kFewest));
  mean_lag_ = lags / static_cast<double>(periods_.size());
}

Delays Delays::read(const std::filesystem::path& file) {
  const std::vector<DelaySample> samples = SampleFile(file).samples();
  try {
    return Delays(samples);
  } catch (const std::invalid_argument& error) {
    throw DelayError(file.string() + ": " + error.what());
  }
}

std::string Delays::note() const {
  constexpr double kLeastRate = 0.5 / kPeriod;  // Hz
  if (rate_ == 0.0 || rate_ >= kLeastRate) return {};
  return "note: the delays were measured with " + std::to_string(std::llround(rate_)) +
         " poses a second; a device at 1 kHz, whose poses go out that seldom, is judged\n";
}

std::size_t Delays::worstStretch(std::size_t length) const noexcept {
  std::size_t sum = 0, worst = 0, begin = 0;
  for (std::size_t i = 0; i < periods_.size() + length; ++i) {
    sum += at(i).lag;
    if (i >= length) sum -= at(i - length).lag;
    if (i + 1 < length || sum <= worst) continue;
    worst = sum;
    begin = i + 1 - length;
  }
  return begin % periods_.size();
}

}  // namespace palpate::device
