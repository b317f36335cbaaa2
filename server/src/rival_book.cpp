// SPDX-License-Identifier: Apache-2.0
#include "palpate/server/rival_book.h"

#include <algorithm>
#include <cstdio>

#include "palpate/idl/printable.h"

namespace palpate::server {
namespace {

bool isFree(const OtherServer& other) noexcept {
  return other.last_ns == 0;
}

}  // namespace

// The place of this server, a free one, or that of a server that is gone.
OtherServer* RivalBook::place(std::uint32_t server_id, std::uint64_t session, std::int64_t now_ns) noexcept {
  OtherServer* room = nullptr;
  for (OtherServer& other : others_) {
    if (!isFree(other) && other.server_id == server_id && other.session == session) return &other;
    if (room == nullptr && (isFree(other) || now_ns - other.last_ns > kGoneNs)) room = &other;
  }
  if (room == nullptr) return nullptr;
  *room = OtherServer{};
  room->server_id = server_id;
  room->session = session;
  room->first_ns = now_ns;
  return room;
}

void RivalBook::heardForce(const dds::ToolForce& force, dds::WriterId writer, std::int64_t now_ns) noexcept {
  if (force.tool_id >= static_cast<std::uint32_t>(facts_.step.tools)) return;
  if (!facts_.answers_any && force.server_id != facts_.server_id) return;
  const std::unique_lock lock(mutex_, std::try_to_lock);
  OtherServer* const other = lock ? place(force.server_id, force.session, now_ns) : nullptr;
  if (other == nullptr) return;
  other->force_writer = writer;
  other->last_ns = now_ns;
}

void RivalBook::heardStatus(const dds::ServerStatus& status, dds::WriterId writer,
                            std::int64_t now_ns) noexcept {
  const std::unique_lock lock(mutex_, std::try_to_lock);
  OtherServer* const other = lock ? place(status.server_id, status.session, now_ns) : nullptr;
  if (other == nullptr) return;
  other->status_writer = writer;
  other->last_ns = now_ns;
  other->state = status.state;
  other->answers_any = status.answers_any;
  other->pid = status.pid;
  std::copy(std::begin(status.host), std::end(status.host), other->host.begin());
  std::copy(std::begin(status.model_id), std::end(status.model_id), other->model_id.begin());
  starter_ = starter_ || (status.state == dds::server_state::kStarting && clashes(*other));
}

bool RivalBook::clashes(const OtherServer& other) const noexcept {
  return other.server_id == facts_.server_id || (facts_.answers_any && other.answers_any);
}

std::vector<OtherServer> RivalBook::rivals(std::int64_t now_ns, std::int64_t grace_ns) const {
  const std::lock_guard lock(mutex_);
  std::vector<OtherServer> found;
  for (const OtherServer& other : others_) {
    if (isFree(other) || now_ns - other.last_ns > kGoneNs || !clashes(other)) continue;
    const bool stops = other.hasStatus() && other.state == dds::server_state::kStopping;
    const bool known = other.hasStatus() || other.server_id == facts_.server_id;
    if (!stops && (known || now_ns - other.first_ns >= grace_ns)) found.push_back(other);
  }
  return found;
}

bool RivalBook::takeStarter() {
  const std::lock_guard lock(mutex_);
  return std::exchange(starter_, false);
}

std::string describe(const OtherServer& other) {
  std::array<char, 64> session{};
  std::snprintf(session.data(), session.size(), "%016llx", static_cast<unsigned long long>(other.session));
  std::string text = "server " + std::to_string(other.server_id) + ", session " + session.data();
  if (!other.hasStatus()) return text + ", which sends forces but no status";
  return text + ", on " + dds::printable(other.host.data()) + ", pid " + std::to_string(other.pid) +
         ", model " + dds::printable(other.model_id.data());
}

}  // namespace palpate::server
