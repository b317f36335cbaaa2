// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "organ_feed.h"
#include "parameter_desk.h"
#include "tool_desk.h"

namespace palpate::viewer {

/// What the viewer tells a page that it serves.
class PageListener {
 public:
  PageListener() = default;
  PageListener(const PageListener&) = delete;
  PageListener& operator=(const PageListener&) = delete;
  virtual ~PageListener() = default;
  [[nodiscard]] virtual std::uint64_t id() const noexcept = 0;
  virtual void toolEnded(const std::string& message) = 0;
  virtual void answered(const ParameterDesk::Answer& answer) = 0;
  /// Time to look whether another program sends the tool that the page drives.
  virtual void lookForRival(std::int64_t now_ns) = 0;
};

/// State shared by all pages: data from DDS, the tools that pages drive, the parameters that they set.
/// Threads: one, the web thread.
class Viewer {
 public:
  /// @param[in] wake  called on DDS's thread when a field comes
  /// @param[in] wanted  servers that may be followed  @throw dds::DdsError
  Viewer(const dds::Participant& participant, const client::WantedServer& wanted, double rate_hz,
         std::vector<std::uint32_t> tool_ids, WakeFunction wake, void* context);

  /// Takes in what came and passes it on; call about every 20 ms.
  void tend(std::int64_t now_ns);

  void add(PageListener& page);
  void remove(PageListener& page);

  OrganFeed feed;
  ToolDesk tools;
  ParameterDesk parameters;

  [[nodiscard]] const std::vector<PageListener*>& pages() const noexcept { return pages_; }
  [[nodiscard]] const ServerState& state() const noexcept { return state_; }
  /// Rises when state() changes; above 0 after the first tend().
  [[nodiscard]] std::uint64_t stateVersion() const noexcept { return state_version_; }

 private:
  void tendTools(std::int64_t now_ns);
  void tendParameters(std::int64_t now_ns);
  [[nodiscard]] PageListener* find(std::uint64_t page_id) const;

  std::vector<PageListener*> pages_;
  ServerState state_;
  std::uint64_t state_version_{0};
  std::uint32_t surface_revision_{0};
};

}  // namespace palpate::viewer
