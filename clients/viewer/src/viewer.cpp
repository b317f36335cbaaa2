// SPDX-License-Identifier: Apache-2.0
#include "viewer.h"

#include <spdlog/spdlog.h>

#include <algorithm>

namespace palpate::viewer {

Viewer::Viewer(const dds::Participant& participant, const client::WantedServer& wanted, double rate_hz,
               std::vector<std::uint32_t> tool_ids, WakeFunction wake, void* context)
    : feed(participant, wanted, rate_hz, wake, context),
      tools(participant, std::move(tool_ids)),
      parameters(participant) {
  feed.setWatched(false);
}

void Viewer::tend(std::int64_t now_ns) {
  for (const std::uint32_t id : feed.poll(now_ns, tools.writerId())) tools.sawForeignPose(id, now_ns);
  ServerState state = feed.state(now_ns);
  if (state != state_) {
    if (state.name != state_.name) spdlog::info("{}", state.text);
    state_ = std::move(state);
    ++state_version_;
  }
  tendTools(now_ns);
  tendParameters(now_ns);
}

void Viewer::tendTools(std::int64_t now_ns) {
  const auto& status = feed.watch().status();
  if (state_.name == "serving" && status) {
    tools.setServer({status->session, status->server_id, status->tools, status->speed_limit});
  } else {
    tools.setNoServer();
  }
  if (feed.revision() != surface_revision_) {
    if (surface_revision_ != 0) tools.endAll("another organ is shown now");
    surface_revision_ = feed.revision();
    tools.setSurface(*feed.surface());
  }
  for (const ToolDesk::Ending& ending : tools.endings())
    if (PageListener* page = find(ending.page_id)) page->toolEnded(ending.message);
  for (PageListener* page : pages_) page->lookForRival(now_ns);
}

void Viewer::tendParameters(std::int64_t now_ns) {
  for (const dds::ServerParameters& answer : feed.newParameters()) parameters.saw(answer);
  parameters.tend(feed.watch().alive(now_ns) ? feed.parameters() : std::nullopt, now_ns);
  for (const ParameterDesk::Answer& answer : parameters.answers())
    if (PageListener* page = find(answer.page_id)) page->answered(answer);
}

void Viewer::add(PageListener& page) {
  pages_.push_back(&page);
  feed.setWatched(true);
}

void Viewer::remove(PageListener& page) {
  std::erase(pages_, &page);
  tools.drop(page.id());
  parameters.drop(page.id());
  feed.setWatched(!pages_.empty());
}

PageListener* Viewer::find(std::uint64_t page_id) const {
  const auto at = std::find_if(pages_.begin(), pages_.end(),
                               [&](const PageListener* page) { return page->id() == page_id; });
  return at == pages_.end() ? nullptr : *at;
}

}  // namespace palpate::viewer
