// SPDX-License-Identifier: Apache-2.0
#include "palpate/client/server_finder.h"

#include <algorithm>
#include <cmath>
#include <iostream>
#include <new>
#include <thread>
#include <utility>

#include "palpate/client/error.h"
#include "palpate/client/no_server.h"
#include "palpate/client/stop_signal.h"
#include "palpate/idl/outsider_watch.h"

namespace palpate::client {
namespace {

// One that is there and does not meet us, where topics are signed. Without an identity of ours DDS keeps silent about it.
std::string outsiderOf(const dds::Participant& participant) {
  if (!participant.identity()) return {};
  const std::vector<std::string> lines = dds::OutsiderWatch(participant, std::chrono::milliseconds(0)).poll();
  return lines.empty() ? std::string() : lines.front();
}

}  // namespace

ServerFinder::ServerFinder(const dds::Participant& participant, const WantedServer& wanted)
    : participant_(participant),
      wanted_(wanted),
      statuses_(participant, nullptr, nullptr, dds::Wants::kHistory),
      surfaces_(participant, nullptr, this, &ServerFinder::onSurface) {}

// DDS calls it for each sample before it keeps one. The sample is copied here and not kept: DDS would keep the mesh of every
// session that somebody invents.
bool ServerFinder::onSurface(const dds::SurfaceMesh& message, void* context) noexcept {
  constexpr std::size_t kMostArrived = 16;  // between two looks
  auto& self = *static_cast<ServerFinder*>(context);
  try {
    const std::lock_guard lock(self.mutex_);
    if (self.arrived_.size() == kMostArrived) return false;
    try {
      self.arrived_.push_back(checkedSurface(message));
    } catch (const ClientError& error) {
      self.arrived_refusal_ = error.what();
    }
  } catch (const std::bad_alloc&) {  // too large to keep
    return false;
  }
  return false;
}

// Each comes once, and maybe before its server's status.
void ServerFinder::takeSurfaces() {
  constexpr std::size_t kMostKept = 16;
  std::vector<Surface> arrived;
  {
    const std::lock_guard lock(mutex_);
    arrived.swap(arrived_);
    if (!arrived_refusal_.empty()) refusal_ = std::exchange(arrived_refusal_, {});
  }
  for (Surface& surface : arrived) {
    if (kept_.size() == kMostKept) kept_.erase(kept_.begin());
    kept_.push_back(std::move(surface));
  }
}

bool ServerFinder::look(ServerInfo& info) {
  takeSurfaces();
  for (const dds::ServerStatus& status : statuses_.running()) {
    if (!wanted_.fits(status)) continue;
    has_status_ = true;
    const auto fits = std::find_if(kept_.begin(), kept_.end(), [&](const Surface& surface) {
      return surface.session == status.session && surface.organ_id == status.organ_id &&
             surface.model_id == status.model_id;
    });
    if (fits == kept_.end()) continue;
    info = {status, *fits};
    return true;
  }
  return false;
}

std::vector<std::string> ServerFinder::others(const ServerInfo& found) const {
  std::vector<std::string> lines;
  for (const dds::ServerStatus& status : statuses_.running())
    if (runOf(status) != runOf(found)) lines.push_back(describe(status));
  return lines;
}

std::string ServerFinder::missing(std::chrono::milliseconds waited) const {
  const std::string where = client::where(participant_.domain(), waited);
  for (const std::string& mismatch : {statuses_.mismatch(), surfaces_.mismatch()})
    if (!mismatch.empty()) return "no server fits" + where + ": " + mismatch;
  if (!refusal_.empty()) return refusal_;
  if (const std::string outsider = outsiderOf(participant_); !has_status_ && !outsider.empty())
    return "no server" + where + "; " + outsider;
  if (!has_status_ && !wanted_.any()) return "no " + nameOf(wanted_) + where + kNoServerHint;
  if (!has_status_ && kept_.empty()) return "no server" + where + kNoServerHint;
  if (!has_status_)
    return "no running server's status (" + std::string(dds::TopicTraits<dds::ServerStatus>::kName) + ")" +
           where;
  if (kept_.empty())
    return "no organ's surface (" + std::string(dds::TopicTraits<dds::SurfaceMesh>::kName) + ")" + where;
  return "the surface and the server's status name different models" + where + ": do two servers run?";
}

ServerInfo ServerFinder::wait(std::chrono::milliseconds timeout) {
  using namespace std::chrono_literals;
  const auto deadline = std::chrono::steady_clock::now() + timeout;
  ServerInfo info;
  while (!look(info)) {
    if (stopRequested()) throw ClientError("interrupted while waiting for a server");
    if (std::chrono::steady_clock::now() >= deadline) throw ClientError(missing(timeout));
    std::this_thread::sleep_for(5ms);
  }
  for (const double radius : info.status.tip_radius)
    if (!(radius >= 0.0 && radius <= 0.05))
      throw ClientError("the server's status says tip_radius " + std::to_string(radius) +
                        " m, expected 0 to 0.05");
  return info;
}

ServerInfo findServer(const dds::Participant& participant, double seconds, const WantedServer& wanted) {
  std::cerr << "waiting for a server on DDS domain " << participant.domain() << "\n";
  ServerFinder finder(participant, wanted);
  ServerInfo server = finder.wait(std::chrono::milliseconds(static_cast<long>(seconds * 1e3)));
  for (const std::string& other : finder.others(server))
    std::cerr << "note: held on to " << describe(server.status) << "; there is " << other << "\n";
  return server;
}

}  // namespace palpate::client
