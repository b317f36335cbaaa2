// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>

#include "palpate/idl/endpoint_watch.h"
#include "palpate/idl/participant_of.h"
#include "palpate/idl/tap.h"
#include "palpate/server/announcement_book.h"
#include "palpate/server/channels.h"
#include "palpate/server/facts.h"
#include "palpate/server/parameter_book.h"

namespace palpate::server {

/// What drivers say of their devices. Only the participant whose poses a tool's are speaks for that tool, for as long as it
/// is there (docs/decisions/announcements.md). Threads: one, the events thread. Real-time: no.
class Announcements {
 public:
  /// What the owner of each tool says; nothing: it says nothing, or there is none.
  using ByTool = std::array<std::optional<DriverWord>, kMaxTools>;

  /// @throw dds::DdsError
  Announcements(const dds::Participant& participant, Channels& channels, const Facts& facts);

  /// @param[in] poses  the reader of the poses, which knows their writers
  [[nodiscard]] ByTool poll(dds_entity_t poses);

  void show(dds::EndpointWatch& watch) const { watch.add(tap_.handle(), false); }

 private:
  using Owners = std::array<std::optional<dds::ParticipantId>, kMaxTools>;

  /// On DDS's receive thread.
  static void onSaid(const dds::ToolAnnouncement& said, dds::WriterId writer, void* context) noexcept;
  [[nodiscard]] Owners ownersOf(dds_entity_t poses) const;
  void preferOwners(const Owners& owners, std::int64_t now_ns);

  Channels& channels_;
  std::uint32_t server_id_;
  bool answers_any_;
  AnnouncementBook book_;
  std::uint64_t surplus_{0};
  std::int64_t preferred_ns_{0};
  dds::Tap<dds::ToolAnnouncement> tap_;  // last: its callback uses the rest
};

}  // namespace palpate::server
