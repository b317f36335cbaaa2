// SPDX-License-Identifier: Apache-2.0
#include "palpate/client/status_board.h"

#include <algorithm>

#include "palpate/idl/printable.h"
#include "palpate/rt/clock.h"

namespace palpate::client {

std::string describe(const dds::ServerStatus& status) {
  return nameOf(runOf(status)) + ", on " + dds::printable(status.host) + ", pid " +
         std::to_string(status.pid) + ", model " + dds::printable(status.model_id);
}

StatusBoard::StatusBoard(const dds::Participant& participant, Callback heard, void* context, dds::Wants wants)
    : heard_(heard),
      context_(context),
      tap_(participant, &StatusBoard::onStatus, this, dds::Hears::kAll, wants) {}

void StatusBoard::onStatus(const dds::ServerStatus& status, dds::WriterId writer, void* context) noexcept {
  auto& self = *static_cast<StatusBoard*>(context);
  const bool heard = self.note(status, writer, rt::monotonicNow());
  if (heard && self.heard_ != nullptr) self.heard_(status, self.context_);
}

// In the place of the same run, in a free one, or in that of a server that fell silent. Another writer that names a run which is
// heard is not heard.
bool StatusBoard::note(const dds::ServerStatus& status, dds::WriterId writer, std::int64_t now_ns) noexcept {
  const std::lock_guard lock(mutex_);
  const auto silent = [&](const Entry& entry) { return now_ns - entry.heard_ns > kSilenceNs; };
  auto at = std::find_if(entries_.begin(), entries_.end(), [&](const Entry& entry) {
    return entry.heard_ns != 0 && runOf(entry.status) == runOf(status);
  });
  if (at != entries_.end() && at->writer != writer && !silent(*at)) return false;
  if (at == entries_.end()) {
    at = std::find_if(entries_.begin(), entries_.end(),
                      [&](const Entry& entry) { return entry.heard_ns == 0 || silent(entry); });
    if (at == entries_.end()) return true;
    at->first_ns = now_ns;
  }
  at->status = status;
  at->writer = writer;
  at->heard_ns = now_ns;
  return true;
}

std::vector<HeardStatus> StatusBoard::heardAfter(std::int64_t ns) const {
  std::vector<HeardStatus> found;
  {
    const std::lock_guard lock(mutex_);
    for (const Entry& entry : entries_)
      if (entry.heard_ns > ns) found.push_back({entry.status, entry.writer, entry.heard_ns});
  }
  std::sort(found.begin(), found.end(),
            [](const HeardStatus& a, const HeardStatus& b) { return a.heard_ns < b.heard_ns; });
  return found;
}

std::vector<dds::ServerStatus> StatusBoard::running() const {
  const std::int64_t now_ns = rt::monotonicNow();
  std::vector<Entry> found;
  {
    const std::lock_guard lock(mutex_);
    std::copy_if(entries_.begin(), entries_.end(), std::back_inserter(found), [&](const Entry& entry) {
      return entry.heard_ns != 0 && now_ns - entry.heard_ns <= kSilenceNs &&
             entry.status.state == dds::server_state::kRunning;
    });
  }
  std::sort(found.begin(), found.end(),
            [](const Entry& a, const Entry& b) { return a.first_ns < b.first_ns; });
  std::vector<dds::ServerStatus> statuses;
  for (const Entry& entry : found) statuses.push_back(entry.status);
  return statuses;
}

std::optional<dds::ServerStatus> StatusBoard::find(const ServerRun& run) const {
  const std::lock_guard lock(mutex_);
  for (const Entry& entry : entries_)
    if (entry.heard_ns != 0 && runOf(entry.status) == run) return entry.status;
  return std::nullopt;
}

}  // namespace palpate::client
