// SPDX-License-Identifier: Apache-2.0
#include "server_watch.h"

#include "palpate/idl/printable.h"

namespace palpate::viewer {
namespace {

std::string secondsOf(std::int64_t ns) {
  return std::to_string(ns / 1'000'000'000) + " s";
}

}  // namespace

bool ServerWatch::saw(const dds::ServerStatus& status, std::int64_t now_ns, dds::WriterId writer) {
  const bool stopping = status.state == dds::server_state::kStopping;
  if (!wanted_.fits(status)) {
    others_.erase(status.session);
    if (!stopping) keepOther(status, now_ns);
    return false;
  }
  const bool another = status_ && status_->session != status.session;
  if (status_ && !another && alive(now_ns) && writer != writer_) return false;
  const bool begins = status_ && status_->state == dds::server_state::kStarting &&
                      status.state == dds::server_state::kRunning;  // the other one began first
  const bool held = alive(now_ns) && status_->state != dds::server_state::kStopping && !begins;
  if (another && (held || stopping)) {
    others_.erase(status.session);
    if (!stopping) keepOther(status, now_ns);
    return false;
  }
  others_.erase(status.session);
  status_ = status;
  writer_ = writer;
  heard_ns_ = now_ns;
  return true;
}

void ServerWatch::keepOther(const dds::ServerStatus& status, std::int64_t now_ns) {
  std::erase_if(others_, [&](const auto& other) { return now_ns - other.second.heard_ns > kSilenceNs; });
  if (others_.size() >= kMostOthers) return;
  others_[status.session] = {"server " + std::to_string(status.server_id) + " (" +
                                 dds::printable(status.host) + ", process " + std::to_string(status.pid) +
                                 ")",
                             now_ns};
}

std::string ServerWatch::othersAt(std::int64_t now_ns) const {
  std::string words;
  for (const auto& [session, other] : others_)
    if (now_ns - other.heard_ns <= kSilenceNs) words += (words.empty() ? "" : ", ") + other.words;
  return words;
}

std::string ServerWatch::awaited() const {
  return wanted_.any() ? "a server" : nameOf(wanted_);
}

ServerState ServerWatch::state(std::int64_t now_ns, const std::string& surface_model,
                               const std::string& mismatch) const {
  const std::string domain = " on DDS domain " + std::to_string(domain_), others = othersAt(now_ns);
  if (!status_ && !mismatch.empty()) return {"mismatch", "a server" + domain + " does not fit: " + mismatch};
  if (!status_)
    return {"waiting", "waiting for " + awaited() + domain + (others.empty() ? "" : "; not shown: " + others),
            others};
  if (!alive(now_ns)) return {"gone", "no word from the server since " + secondsOf(now_ns - heard_ns_)};
  if (status_->state == dds::server_state::kStopping) return {"gone", "the server stops"};
  if (status_->state == dds::server_state::kStarting) return {"starting", "the server starts"};
  if (surface_model.empty()) return {"waiting", "waiting for the organ's surface"};
  if (surface_model != status_->model_id)
    return {"waiting",
            "the surface is of another model: waiting for that of " + dds::printable(status_->model_id)};
  return {"serving", others.empty() ? "serving" : "serving; also on the domain, not shown: " + others,
          others};
}

}  // namespace palpate::viewer
