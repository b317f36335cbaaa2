// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "palpate/idl/reader.h"
#include "palpate/idl/writer.h"
#include "palpate/server/channels.h"
#include "palpate/server/parameter_book.h"

namespace palpate::server {

/// The newest event about parameters, for the log. Requests that only ask are not logged.
struct ParameterNews {
  std::optional<std::string> changed;  ///< what is in force now
  std::optional<std::string> refused;  ///< why
};

/// Takes parameter requests from DDS, answers each, and hands what was accepted to the tick. Threads: one, the events
/// thread; not urgent. Real-time: no.
class ParameterService {
 public:
  /// Publishes what is in force. @throw dds::DdsError
  ParameterService(const dds::Participant& participant, Channels& channels, const Facts& facts);

  /// Answers the requests that have come, at most dds::kMaxTake. @return what of it is worth a line in the log
  [[nodiscard]] ParameterNews poll();

  [[nodiscard]] const ParameterBook& book() const noexcept { return book_; }

 private:
  void serve(const dds::ParameterRequest& request, ParameterNews& news);

  Channels& channels_;
  std::uint32_t server_id_;
  ParameterBook book_;
  dds::Writer<dds::ServerParameters> answers_;
  dds::Reader<dds::ParameterRequest> requests_;
};

}  // namespace palpate::server
