// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "organ_feed.h"
#include "parameter_desk.h"
#include "tool_desk.h"

namespace palpate::viewer {

class Page;

/// State shared by all pages: data from DDS, the tools that pages drive, the parameters that they set.
/// Threads: one, the web thread.
class Viewer {
 public:
  /// @param[in] wake  called on DDS's thread when a field comes
  /// @param[in] server_id  the only server that is followed, or SERVER_ANY  @throw dds::DdsError
  Viewer(const dds::Participant& participant, std::uint32_t server_id, double rate_hz,
         std::vector<std::uint32_t> tool_ids, WakeFunction wake, void* context);

  /// Takes in what came and passes it on; call about every 20 ms.
  void tend(std::int64_t now_ns);

  void add(Page& page);
  void remove(Page& page);

  OrganFeed feed;
  ToolDesk tools;
  ParameterDesk parameters;

  [[nodiscard]] const std::vector<Page*>& pages() const noexcept { return pages_; }
  [[nodiscard]] const ServerState& state() const noexcept { return state_; }
  /// Rises when state() changes; above 0 after the first tend().
  [[nodiscard]] std::uint64_t stateVersion() const noexcept { return state_version_; }

 private:
  void tendTools(std::int64_t now_ns);
  void tendParameters(std::int64_t now_ns);
  [[nodiscard]] Page* find(std::uint64_t page_id) const;

  std::vector<Page*> pages_;
  ServerState state_;
  std::uint64_t state_version_{0};
  std::uint32_t surface_revision_{0};
};

}  // namespace palpate::viewer
