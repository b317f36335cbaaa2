// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "palpate/idl/endpoint_watch.h"
#include "palpate/idl/process_of.h"
#include "palpate/rt/phase_lock.h"
#include "palpate/server/channels.h"
#include "palpate/server/health.h"
#include "palpate/server/lines_in_turn.h"
#include "palpate/server/parameter_service.h"
#include "palpate/server/rest_surface.h"
#include "palpate/server/rival_watch.h"
#include "palpate/server/security_watch.h"
#include "palpate/server/status_publisher.h"

namespace palpate::server {

/// Turns the records of the other threads into log lines and ServerStatus, and answers parameter requests. The only
/// thread that logs while the server runs. Each kind of line that a client can cause is logged at most once per second,
/// so that no client can fill a disk.
class Events {
 public:
  Events(Channels& channels, StatusPublisher& status, ParameterService& parameters, RivalWatch& rivals)
      : channels_(channels), status_(status), parameters_(parameters), rivals_(rivals) {
    noteParameters();
  }

  /// Also raise receive threads that DDS makes later. Before run().
  void raiseReceiveThreads() noexcept { raise_receive_threads_ = true; }

  /// Also log others' endpoints that do not match ours, and repeat the rest surface for readers without history. Before
  /// run(); both must outlive the thread.
  void serveStrangers(dds::EndpointWatch& endpoints, RestSurface& surface) noexcept {
    endpoints_ = &endpoints;
    rest_surface_ = &surface;
  }

  /// Also find out which tools are driven from this host. Before run(); `processes` must outlive the thread.
  /// @param[in] poses  the reader of the poses, which knows their writers
  void lookForOwners(const dds::ProcessBook& processes, dds_entity_t poses) noexcept {
    processes_ = &processes;
    poses_ = poses;
  }

  /// Also log who is not let in. Before run(); `security` must outlive the thread.
  void watchSecurity(SecurityWatch& security) noexcept { security_ = &security; }

  /// Body of the events thread. Returns when the server stops, after it has published that.
  void run() noexcept;

  /// Takes what lies in the rings. @param[in] now_ns  our monotonic clock
  void drain(std::int64_t now_ns);

  [[nodiscard]] const Health& health() const noexcept { return health_; }

 private:
  void noteParameters();
  void noteMisfits(std::int64_t now_ns);
  void noteSecurity(std::int64_t now_ns);
  void noteUnknownTools(std::int64_t now_ns);
  void noteRivals(std::int64_t now_ns);
  void noteMisaddressed(std::int64_t now_ns);
  void noteRequestFloods(std::int64_t now_ns);
  void noteRecording(std::int64_t now_ns);
  void noteOwners();
  void noteDelays(std::int64_t now_ns);
  void noteLateTicks(std::int64_t now_ns);
  void noteClockSteps(std::int64_t now_ns);
  void noteTick(const TickRecord& record, std::int64_t now_ns);
  void raiseLateThreads(std::int64_t now_ns);
  void notePhase(std::uint32_t phase, std::int64_t now_ns);
  void noteFlags(std::size_t tool, std::uint32_t flags, std::int64_t now_ns);
  /// Whether a line of this kind may be written: once a second.
  [[nodiscard]] bool isDue(std::uint64_t kind, std::int64_t now_ns);
  void warn(std::uint64_t kind, const std::string& text, std::int64_t now_ns);
  void warn(const std::string& text);
  void warnInTurn(std::uint64_t kind, std::vector<std::string> lines, LinesInTurn& waiting,
                  std::int64_t now_ns);
  void info(const std::string& text);
  void publishIfDue(std::int64_t now_ns);

  Channels& channels_;
  StatusPublisher& status_;
  ParameterService& parameters_;
  RivalWatch& rivals_;
  dds::EndpointWatch* endpoints_{nullptr};
  RestSurface* rest_surface_{nullptr};
  SecurityWatch* security_{nullptr};
  LinesInTurn misfits_, outsiders_, dds_lines_;
  const dds::ProcessBook* processes_{nullptr};
  dds_entity_t poses_{0};
  std::array<std::uint64_t, kMaxTools> owners_{};  // as channels_.owners, looked up
  std::uint64_t unjudged_{0};
  Health health_;
  std::array<std::uint32_t, kMaxTools> last_flags_{};
  std::map<std::uint64_t, std::int64_t> last_told_ns_;  // by kind of event; a fixed, small set
  bool changed_{true};                                  // since the last status
  std::int64_t published_ns_{0};
  std::uint32_t told_phase_{static_cast<std::uint32_t>(rt::PhaseState::kFree)};
  bool raise_receive_threads_{false};
  std::int64_t raised_ns_{0};
  std::int64_t requests_counted_ns_{0};
  std::uint64_t foreign_requests_{0};
  std::uint64_t surplus_announcements_{0};
  std::int64_t rival_told_ns_{0};
  bool recording_failed_{false};
  std::uint64_t unrecorded_{0};
};

}  // namespace palpate::server
