// SPDX-License-Identifier: Apache-2.0
#include "tool_desk.h"

#include <algorithm>
#include <cmath>

#include "palpate/rt/clock.h"
#include "palpate/rt/pacer.h"
#include "palpate/rt/scheduling.h"

namespace palpate::viewer {
namespace {

dds::ToolPose poseAt(std::uint32_t server_id, std::uint32_t tool_id, std::uint64_t seq, std::int64_t now_ns,
                     const device::Point& p_WT) {
  dds::ToolPose pose{};
  pose.server_id = server_id;
  pose.tool_id = tool_id;
  pose.seq = seq;
  pose.stamp_ns = now_ns;
  std::copy(p_WT.begin(), p_WT.end(), pose.position);
  pose.orientation[3] = 1.0;
  return pose;
}

}  // namespace

ToolDesk::ToolDesk(const dds::Participant& participant, std::vector<std::uint32_t> ids)
    : ids_(std::move(ids)) {
  if (participant.mayWrite(dds::TopicTraits<dds::ToolPose>::kName)) writer_.emplace(participant);
  for (Tool& tool : tools_) tool.seq = static_cast<std::uint64_t>(rt::monotonicNow());
  thread_ = std::thread([this] { run(); });
}

ToolDesk::~ToolDesk() {
  {
    const std::lock_guard lock(mutex_);
    stop_ = true;
  }
  driven_.notify_one();
  thread_.join();
}

void ToolDesk::setServer(const Server& server) {
  server_tools_ = server.tools;
  speed_ = server.speed_limit > 0.0 ? std::min(kMaxSpeed, 0.5 * server.speed_limit) : kMaxSpeed;
  if (std::exchange(session_, server.session) == server.session) return;
  endAll("another server serves now");
  const std::lock_guard lock(mutex_);
  server_id_ = server.server_id;
}

void ToolDesk::endAll(const char* message) {
  const std::int64_t now_ns = rt::monotonicNow();
  const std::lock_guard lock(mutex_);
  for (Tool& tool : tools_)
    if (tool.driven) end(tool, message, now_ns);
}

void ToolDesk::sawForeignPose(std::uint32_t tool_id, std::int64_t now_ns) noexcept {
  if (tool_id >= kTools) return;
  const std::lock_guard lock(mutex_);
  tools_[tool_id].foreign_ns = now_ns;
}

ToolGrant ToolDesk::grab(std::uint64_t page_id) {
  if (!writer_) return {false, 0, "this page may look only"};
  if (server_tools_ == 0) return {false, 0, "no server answers tools yet"};
  const std::int64_t now_ns = rt::monotonicNow();
  const std::lock_guard lock(mutex_);
  // The answer to this grab is newer than the pending endings.
  std::erase_if(endings_, [&](const Ending& ending) { return ending.page_id == page_id; });
  if (Tool* own = find(page_id)) {
    if (own->driven->follower.state() != device::PoseFollower::State::kOver) {
      own->driven->follower.regrab(now_ns);
      return {true, static_cast<std::uint32_t>(own - tools_.data()), ""};
    }
    rest(*own, now_ns);
  }
  for (const std::uint32_t id : ids_) {
    if (id >= std::min<std::size_t>(server_tools_, kTools)) continue;
    Tool& tool = tools_[id];
    const bool taken = tool.foreign_ns != 0 && now_ns - tool.foreign_ns < kTakenNs;
    if (tool.driven || taken || now_ns < tool.rests_ns) continue;
    tool.driven.emplace(Driven{page_id, device::PoseFollower(now_ns, speed_)});
    driven_.notify_one();
    return {true, id, ""};
  }
  return {false, 0, "all tools are in use: try again when one is free"};
}

bool ToolDesk::target(std::uint64_t page_id, const device::Point& p_WT) {
  const std::lock_guard lock(mutex_);
  Tool* tool = find(page_id);
  if (tool == nullptr) return false;
  tool->driven->follower.target(p_WT, rt::monotonicNow());
  return true;
}

void ToolDesk::release(std::uint64_t page_id) {
  std::optional<std::uint32_t> id = toolOf(page_id);
  if (!id) return;
  const auto tip = tipOf(*id);
  const device::Point outward = outward_.at(tip.value_or(device::Point{}));
  const std::lock_guard lock(mutex_);
  if (Tool* tool = find(page_id)) tool->driven->follower.release(outward);
}

void ToolDesk::drop(std::uint64_t page_id) {
  const std::lock_guard lock(mutex_);
  if (Tool* tool = find(page_id)) rest(*tool, rt::monotonicNow());
}

std::vector<ToolDesk::Ending> ToolDesk::endings() {
  const std::lock_guard lock(mutex_);
  return std::exchange(endings_, {});
}

std::optional<std::uint32_t> ToolDesk::toolOf(std::uint64_t page_id) const {
  const std::lock_guard lock(mutex_);
  for (std::uint32_t id = 0; id < kTools; ++id)
    if (tools_[id].driven && tools_[id].driven->page_id == page_id) return id;
  return std::nullopt;
}

std::optional<device::Point> ToolDesk::tipOf(std::uint32_t tool_id) const {
  const std::lock_guard lock(mutex_);
  if (tool_id >= kTools || !tools_[tool_id].driven) return std::nullopt;
  const device::PoseFollower& follower = tools_[tool_id].driven->follower;
  if (follower.state() == device::PoseFollower::State::kWaiting) return std::nullopt;
  return follower.position();
}

dds_instance_handle_t ToolDesk::writerId() const noexcept {
  dds_instance_handle_t id = 0;
  if (!writer_) return 0;
  return dds_get_instance_handle(writer_->handle(), &id) == DDS_RETCODE_OK ? id : 0;
}

ToolDesk::Tool* ToolDesk::find(std::uint64_t page_id) {
  const auto at = std::find_if(tools_.begin(), tools_.end(), [&](const Tool& tool) {
    return tool.driven && tool.driven->page_id == page_id;
  });
  return at == tools_.end() ? nullptr : &*at;
}

bool ToolDesk::anyDriven() const {
  return std::any_of(tools_.begin(), tools_.end(), [](const Tool& tool) { return tool.driven.has_value(); });
}

void ToolDesk::end(Tool& tool, const char* message, std::int64_t now_ns) {
  endings_.push_back({tool.driven->page_id, message});
  rest(tool, now_ns);
}

void ToolDesk::rest(Tool& tool, std::int64_t now_ns) {
  tool.driven.reset();
  tool.rests_ns = now_ns + kRestNs;
}

void ToolDesk::stepAll(std::int64_t now_ns, std::vector<dds::ToolPose>& poses) {
  poses.clear();
  for (std::uint32_t id = 0; id < kTools; ++id) {
    Tool& tool = tools_[id];
    if (!tool.driven) continue;
    device::PoseFollower& follower = tool.driven->follower;
    const bool released = follower.state() == device::PoseFollower::State::kLifting ||
                          follower.state() == device::PoseFollower::State::kOver;  // before its first target
    if (const auto p_WT = follower.step(now_ns))
      poses.push_back(poseAt(server_id_, id, ++tool.seq, now_ns, *p_WT));
    if (follower.state() == device::PoseFollower::State::kOver)
      end(tool, released ? "released" : "no target came for 250 ms", now_ns);
  }
}

void ToolDesk::run() {
  // Below the server's threads; an ordinary thread where the kernel refuses.
  constexpr int kPriority = 30;
  (void)rt::raiseThisThread(kPriority);
  std::vector<dds::ToolPose> poses;
  std::unique_lock lock(mutex_);
  while (!stop_) {
    driven_.wait(lock, [this] { return stop_ || anyDriven(); });
    rt::Pacer pacer(1'000'000);
    while (!stop_ && anyDriven()) {
      stepAll(rt::monotonicNow(), poses);
      lock.unlock();
      for (const dds::ToolPose& pose : poses) (void)writer_->write(pose);
      pacer.wait();
      lock.lock();
    }
  }
}

}  // namespace palpate::viewer
