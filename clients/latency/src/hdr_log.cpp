// SPDX-License-Identifier: Apache-2.0
#include "hdr_log.h"

#include <openssl/evp.h>
#include <zlib.h>

#include <algorithm>
#include <bit>
#include <concepts>
#include <cstddef>
#include <ctime>
#include <stdexcept>

#include "tools/program/printed.h"

namespace palpate::latency {
namespace {

using Bytes = std::vector<unsigned char>;

constexpr int kDigits = 3;
constexpr int kHalfBits =
    10;  // 2 * 10^kDigits fits into 2^11 linear buckets, of which each power of two adds half
constexpr std::int64_t kHighest = std::int64_t{1} << 40;  // ns: what CycleStats tells apart
constexpr std::uint32_t kPlainCookie = 0x1c849313;
constexpr std::uint32_t kDeflatedCookie = 0x1c849314;

/// Of the count of a value in HdrHistogram's array.
std::size_t indexOf(std::int64_t ns) {
  const auto value = static_cast<std::uint64_t>(std::clamp<std::int64_t>(ns, 0, kHighest));
  const int shift = std::max(0, static_cast<int>(std::bit_width(value)) - (kHalfBits + 1));
  return (static_cast<std::size_t>(shift) << kHalfBits) + static_cast<std::size_t>(value >> shift);
}

/// Counts up to that of the largest value.
std::vector<std::int64_t> countsOf(const rt::CycleStats& times) {
  std::vector<std::int64_t> counts(indexOf(times.max()) + 1);
  for (std::size_t i = 0; i < rt::CycleStats::kBuckets; ++i) {
    const auto [upper_ns, count] = times.bucket(i);
    if (count > 0) counts[indexOf(std::min(upper_ns, times.max()))] += static_cast<std::int64_t>(count);
  }
  return counts;
}

void appendBigEndian(Bytes& bytes, std::unsigned_integral auto value) {
  for (int shift = 8 * (static_cast<int>(sizeof value) - 1); shift >= 0; shift -= 8)
    bytes.push_back(static_cast<unsigned char>(value >> shift));
}

/// Seven bits a byte, the sign in the lowest; the ninth byte has eight.
void appendZigZag(Bytes& bytes, std::int64_t value) {
  auto rest = (static_cast<std::uint64_t>(value) << 1U) ^ static_cast<std::uint64_t>(value >> 63);
  for (int byte = 0; byte < 8 && rest > 0x7f; ++byte, rest >>= 7U)
    bytes.push_back(static_cast<unsigned char>(rest | 0x80U));
  bytes.push_back(static_cast<unsigned char>(rest));
}

/// Each count; a run of several zeros as the negative of its length.
Bytes payloadOf(const std::vector<std::int64_t>& counts) {
  Bytes payload;
  for (auto at = counts.begin(); at != counts.end();) {
    const auto end = std::find_if(at, counts.end(), [](std::int64_t count) { return count != 0; });
    if (end == at)
      appendZigZag(payload, *at++);
    else
      appendZigZag(payload, end - at == 1 ? 0 : -(end - at));
    at = std::max(at, end);
  }
  return payload;
}

Bytes plainOf(const rt::CycleStats& times) {
  const Bytes payload = payloadOf(countsOf(times));
  Bytes bytes;
  appendBigEndian(bytes, kPlainCookie);
  appendBigEndian(bytes, static_cast<std::uint32_t>(payload.size()));
  appendBigEndian(bytes, std::uint32_t{0});  // no shift of the indices
  appendBigEndian(bytes, std::uint32_t{kDigits});
  appendBigEndian(bytes, std::uint64_t{1});  // the lowest value that is told apart, ns
  appendBigEndian(bytes, static_cast<std::uint64_t>(kHighest));
  appendBigEndian(bytes, std::bit_cast<std::uint64_t>(1.0));  // values are what was counted
  bytes.insert(bytes.end(), payload.begin(), payload.end());
  return bytes;
}

Bytes deflated(const Bytes& plain) {
  uLongf length = compressBound(static_cast<uLong>(plain.size()));
  Bytes packed(length);
  if (compress(packed.data(), &length, plain.data(), static_cast<uLong>(plain.size())) != Z_OK)
    throw std::runtime_error("zlib cannot compress a histogram");
  Bytes bytes;
  appendBigEndian(bytes, kDeflatedCookie);
  appendBigEndian(bytes, static_cast<std::uint32_t>(length));
  bytes.insert(bytes.end(), packed.begin(), packed.begin() + static_cast<std::ptrdiff_t>(length));
  return bytes;
}

std::string base64(const Bytes& bytes) {
  Bytes text(4 * ((bytes.size() + 2) / 3) + 1);
  const int length = EVP_EncodeBlock(text.data(), bytes.data(), static_cast<int>(bytes.size()));
  if (length < 0) throw std::runtime_error("OpenSSL cannot encode a histogram");
  return {text.begin(), text.begin() + length};
}

std::string dateOf(std::int64_t ms) {
  const std::time_t seconds = ms / 1000;
  std::tm parts{};
  char text[64]{};
  if (gmtime_r(&seconds, &parts) != nullptr)
    std::strftime(text, sizeof text, "%a %b %d %H:%M:%S UTC %Y", &parts);
  return text;
}

}  // namespace

std::string hdrLogOf(const std::vector<TaggedTimes>& all, const Interval& interval) {
  const std::string start =
      program::printed("%.3f (seconds since epoch)", 1e-3 * static_cast<double>(interval.start_ms));
  std::string log =
      "#[palpate-latency; values in ns, Interval_Max in ms]\n#[Histogram log format version 1.3]\n";
  log += "#[StartTime: " + start + ", " + dateOf(interval.start_ms) + "]\n#[BaseTime: " + start + "]\n";
  log += "\"StartTimestamp\",\"Interval_Length\",\"Interval_Max\",\"Interval_Compressed_Histogram\"\n";
  for (const auto& [tag, times] : all)
    if (times->count() > 0)
      log +=
          "Tag=" + tag +
          program::printed(",0.000,%.3f,%.6f,", interval.seconds, 1e-6 * static_cast<double>(times->max())) +
          base64(deflated(plainOf(*times))) + "\n";
  return log;
}

}  // namespace palpate::latency
