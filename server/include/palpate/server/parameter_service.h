// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "palpate/idl/endpoint_watch.h"
#include "palpate/idl/reader.h"
#include "palpate/idl/writer.h"
#include "palpate/rt/token_bucket.h"
#include "palpate/server/announcements.h"
#include "palpate/server/channels.h"
#include "palpate/server/model_exchange.h"
#include "palpate/server/parameter_book.h"

namespace palpate::server {

/// The newest event about parameters, for the log. Requests that only ask are not logged.
struct ParameterNews {
  std::optional<std::string> changed;    ///< what is in force now
  std::optional<std::string> refused;    ///< why
  std::optional<std::string> announced;  ///< a driver's word: what holds for its tool now, or why not
  std::optional<std::string> model;      ///< another one answers from now on
};

/// Takes parameter requests from DDS, answers each, and hands what was accepted to the tick. Requests for other servers, and
/// more than kPerSecond, are dropped where they come in, and counted. Threads: one, the events thread; not urgent. Real-time:
/// no.
class ParameterService {
 public:
  static constexpr std::int64_t kPerSecond = 50;

  /// Publishes what is in force. @throw dds::DdsError
  ParameterService(const dds::Participant& participant, Channels& channels, const Facts& facts);

  /// Takes what drivers announce, too. Before the first poll(). @param[in] poses  the reader of the poses
  void listenToDrivers(dds_entity_t poses) noexcept { poses_ = poses; }

  /// Takes requests for other models, too. Before the first poll().
  void serveModels(ModelExchange& exchange) noexcept { exchange_ = &exchange; }

  /// Answers the requests that have come, at most dds::kMaxTake. @return what of it is worth a line in the log
  [[nodiscard]] ParameterNews poll();

  [[nodiscard]] const ParameterBook& book() const noexcept { return book_; }
  [[nodiscard]] ParameterBook& book() noexcept { return book_; }

  /// Lets the watch compare others' endpoints with ours.
  void show(dds::EndpointWatch& watch) const {
    watch.add(answers_);
    watch.add(requests_);
    announcements_.show(watch);
  }

 private:
  /// On DDS's receive thread.
  static bool admits(const dds::ParameterRequest& request, void* context) noexcept;
  void hearDrivers(ParameterNews& news);
  void serve(const dds::ParameterRequest& request, ParameterNews& news);
  void serveModel(const dds::ParameterRequest& request, ParameterNews& news);
  void noteModel(ParameterNews& news);
  void answerModel(std::uint64_t request_id, const std::string& refusal, bool pending);
  [[nodiscard]] bool leaving() const noexcept { return exchange_ != nullptr && exchange_->leaving(); }
  [[nodiscard]] bool publish(dds::ServerParameters answer);

  Channels& channels_;
  const Facts& facts_;
  ModelExchange* exchange_{nullptr};
  ExchangeOutcome last_model_;  // for whoever asks again
  ParameterBook book_;
  rt::TokenBucket bucket_{kPerSecond, kPerSecond};  // admits()'s
  Announcements announcements_;
  dds_entity_t poses_{0};
  dds::Writer<dds::ServerParameters> answers_;
  dds::Reader<dds::ParameterRequest> requests_;  // last: its filter uses the rest
};

}  // namespace palpate::server
