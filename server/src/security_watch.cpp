// SPDX-License-Identifier: Apache-2.0
#include "palpate/server/security_watch.h"

#include <algorithm>
#include <ctime>
#include <string_view>
#include <utility>

#include "palpate/idl/printable.h"

namespace palpate::server {
namespace {

constexpr std::int64_t kDay = 86'400'000'000'000;

}  // namespace

SecurityWatch::SecurityWatch(const dds::Participant& participant)
    : participant_(participant), outsiders_(participant) {
  dds_set_log_sink(&SecurityWatch::onLine, this);
}

SecurityWatch::~SecurityWatch() {
  dds_set_log_sink(nullptr, nullptr);  // returns when no thread is inside
}

std::string SecurityWatch::pollOwn(std::int64_t now_ns) {
  const dds::Identity& identity = *participant_.identity();
  if (std::time(nullptr) >= identity.expires()) {
    if (std::exchange(expired_, true)) return {};
    return identity.folder().string() + ": has expired, DDS has left the domain and no pose is answered; " +
           identity.remedy() + ", and the server is to be started again with it";
  }
  if (warned_ns_ != 0 && now_ns - warned_ns_ < kDay) return {};
  warned_ns_ = now_ns;
  return identity.warning();
}

std::vector<std::string> SecurityWatch::pollOthers() {
  return outsiders_.poll();
}

std::vector<std::string> SecurityWatch::pollLines() {
  const std::lock_guard lock(mutex_);
  if (line_.empty()) return {};
  std::string line = "DDS: " + std::exchange(line_, {});
  if (const std::uint64_t more = std::exchange(more_, 0); more > 0)
    line += " (and " + std::to_string(more) + " more lines)";
  return {line};
}

// What others' certificates say is printed too.
void SecurityWatch::onLine(void* self, const dds_log_data_t* line) {
  constexpr std::size_t kLongest = 400;
  auto& watch = *static_cast<SecurityWatch*>(self);
  std::string_view text(line->message, std::min<std::size_t>(line->size, kLongest));
  while (!text.empty() && (text.back() == '\n' || text.back() == '\0')) text.remove_suffix(1);
  const std::lock_guard lock(watch.mutex_);
  if (watch.line_.empty())
    watch.line_ = dds::printable(std::string(text).c_str(), kLongest);
  else
    ++watch.more_;
}

}  // namespace palpate::server
