// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>

#include "core/tick/step.h"
#include "palpate/idl/endpoint_watch.h"
#include "palpate/idl/participant.h"
#include "palpate/rt/periodic_thread.h"
#include "palpate/rt/scheduling.h"
#include "palpate/rt/thread.h"
#include "palpate/server/channels.h"
#include "palpate/server/config.h"
#include "palpate/server/events.h"
#include "palpate/server/facts.h"
#include "palpate/server/force_publisher.h"
#include "palpate/server/late_watch.h"
#include "palpate/server/model_exchange.h"
#include "palpate/server/parameter_service.h"
#include "palpate/server/pose_subscriber.h"
#include "palpate/server/recorder.h"
#include "palpate/server/rest_surface.h"
#include "palpate/server/rival_watch.h"
#include "palpate/server/security_watch.h"
#include "palpate/server/service_manager.h"
#include "palpate/server/service_watchdog.h"
#include "palpate/server/surface_publisher.h"
#include "palpate/server/tick.h"

namespace palpate::server {

/// A running server: the threads of docs/design.md, Threads and what they work on, from construction to stop().
class Server {
 public:
  /// Starts everything.
  /// @throw RivalError (another server answers the same poses), record::RecordError, dds::DdsError, rt::RealtimeError (policy require), std::invalid_argument (parameters of the
  /// engine)
  Server(const std::shared_ptr<const MetaModel>& model, const ServerConfig& config);
  ~Server() { (void)stop(); }
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  /// Sends zero force, then ends all threads, what is recorded first. After true the next call does nothing.
  /// @return false: zero force could not be sent, or a thread hangs, and the process must end without destroying this, which would
  /// wait for it
  [[nodiscard]] bool stop();

 private:
  void watchEndpoints();
  void startSecurity();
  void settleRealtime(rt::RealtimePolicy policy);
  void tellOfContact() const;
  void startThreads(const ServerConfig& config);
  void tellServiceManager(const ServerConfig& config);
  [[nodiscard]] bool sendZeroForce();

  Facts facts_;
  std::unique_ptr<Engine> first_;  // until the exchange has it
  Channels channels_;
  std::optional<Recorder> recorder_;
  std::optional<rt::CpuLatencyHold> awake_;

  // The place of this server on its domain, before anything else is sent.
  dds::Participant participant_;
  std::optional<SecurityWatch> security_;  // with an identity
  StatusPublisher status_out_;
  RivalWatch rivals_;

  // In the order of a pose's way: subscriber, tick, publishers.
  ForcePublisher force_out_;
  RestSurface rest_surface_;
  SurfacePublisher surface_out_;
  ParameterService parameters_;
  Events events_;
  Tick tick_;
  ModelExchange exchange_;
  PoseSubscriber poses_in_;
  dds::EndpointWatch endpoints_;
  dds::ProcessBook processes_;

  double ramp_time_;
  std::unique_ptr<rt::Thread> force_thread_;
  std::unique_ptr<rt::Thread> surface_thread_;
  std::unique_ptr<rt::Thread> events_thread_;
  std::unique_ptr<rt::Thread> recorder_thread_;
  std::unique_ptr<rt::PeriodicThread> tick_thread_;
  std::optional<LateWatch> late_watch_;
  std::unique_ptr<rt::Thread> late_thread_;
  ServiceManager service_;
  std::optional<ServiceWatchdog> watchdog_;  // where the manager watches
  std::unique_ptr<rt::Thread> watchdog_thread_;
};

}  // namespace palpate::server
