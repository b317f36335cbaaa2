// SPDX-License-Identifier: Apache-2.0
#include "palpate/client/server_finder.h"

#include <cmath>
#include <iostream>
#include <thread>

#include "palpate/client/error.h"
#include "palpate/client/stop_signal.h"

namespace palpate::client {

ServerFinder::ServerFinder(const dds::Participant& participant)
    : domain_(participant.domain()), statuses_(participant), surfaces_(participant) {}

bool ServerFinder::look(ServerInfo& info) {
  std::array<dds::ServerStatus, dds::kMaxTake> statuses;
  const std::size_t count = statuses_.take(statuses);
  for (std::size_t i = 0; i < count; ++i) {
    if (statuses[i].state != dds::server_state::kRunning) continue;
    info.status = statuses[i];
    has_status_ = true;
  }
  const auto surfaces = surfaces_.takeLoaned();
  for (std::size_t i = 0; i < surfaces.size(); ++i) {
    info.surface = checkedSurface(surfaces[i]);
    has_surface_ = true;
  }
  return has_status_ && has_surface_ && info.status.organ_id == info.surface.organ_id &&
         info.surface.model_id == info.status.model_id;
}

std::string ServerFinder::missing(std::chrono::milliseconds waited) const {
  const std::string where = " on DDS domain " + std::to_string(domain_) + " within " +
                            std::to_string(static_cast<double>(waited.count()) * 1e-3).substr(0, 4) + " s";
  for (const std::string& mismatch : {statuses_.mismatch(), surfaces_.mismatch()})
    if (!mismatch.empty()) return "no server fits" + where + ": " + mismatch;
  const std::string hint =
      "; is palpate-server running there, and does CYCLONEDDS_URI name the same network?";
  if (!has_status_ && !has_surface_) return "no server" + where + hint;
  if (!has_status_)
    return "no running server's status (" + std::string(dds::TopicTraits<dds::ServerStatus>::kName) + ")" +
           where;
  if (!has_surface_)
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
  if (!(info.status.tip_radius >= 0.0 && info.status.tip_radius <= 0.05))
    throw ClientError("the server's status says tip_radius " + std::to_string(info.status.tip_radius) +
                      " m, expected 0 to 0.05");
  return info;
}

ServerInfo findServer(const dds::Participant& participant, double seconds) {
  std::cerr << "waiting for a server on DDS domain " << participant.domain() << "\n";
  return ServerFinder(participant).wait(std::chrono::milliseconds(static_cast<long>(seconds * 1e3)));
}

}  // namespace palpate::client
