// SPDX-License-Identifier: Apache-2.0
#include "server_watch.h"

namespace palpate::viewer {
namespace {

std::string secondsOf(std::int64_t ns) {
  return std::to_string(ns / 1'000'000'000) + " s";
}

}  // namespace

bool ServerWatch::saw(const dds::ServerStatus& status, std::int64_t now_ns) noexcept {
  const bool another = status_ && status_->server_id != status.server_id;
  if (another && alive(now_ns) && status_->state != dds::server_state::kStopping) return false;
  status_ = status;
  heard_ns_ = now_ns;
  return true;
}

ServerState ServerWatch::state(std::int64_t now_ns, const std::string& surface_model,
                               const std::string& mismatch) const {
  const std::string domain = " on DDS domain " + std::to_string(domain_);
  if (!status_ && !mismatch.empty()) return {"mismatch", "a server" + domain + " does not fit: " + mismatch};
  if (!status_) return {"waiting", "waiting for a server" + domain};
  if (!alive(now_ns)) return {"gone", "no word from the server since " + secondsOf(now_ns - heard_ns_)};
  if (status_->state == dds::server_state::kStopping) return {"gone", "the server stops"};
  if (status_->state == dds::server_state::kStarting) return {"starting", "the server starts"};
  if (surface_model.empty()) return {"waiting", "waiting for the organ's surface"};
  if (surface_model != status_->model_id)
    return {"waiting",
            "the surface is of another model: waiting for that of " + std::string(status_->model_id)};
  return {"serving", "serving"};
}

}  // namespace palpate::viewer
