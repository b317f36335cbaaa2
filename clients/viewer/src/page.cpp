// SPDX-License-Identifier: Apache-2.0
#include "page.h"

#include <algorithm>

#include "narrow.h"
#include "palpate/rt/clock.h"

namespace palpate::viewer {

Page::Page(std::uint64_t id, Viewer& viewer, double max_rate_hz)
    : id_(id),
      viewer_(viewer),
      max_rate_hz_(max_rate_hz),
      pace_(max_rate_hz),
      answer_place_(viewer.feed.answers().end()) {
  viewer_.add(*this);
}

Page::~Page() {
  viewer_.remove(*this);
}

Close Page::receive(std::string_view part, bool first, bool last, bool binary, std::int64_t now_ns) {
  if (!parts_.take(now_ns) || (first && !messages_.take(now_ns))) return Close::kPolicy;
  if (binary) return Close::kNotText;
  if (first) incoming_.clear();
  if (incoming_.size() + part.size() > kMaxMessage) return Close::kTooLarge;
  incoming_ += part;
  if (!last) return Close::kNone;
  const auto message = parsePageMessage(incoming_);
  return message ? act(*message) : Close::kPolicy;
}

Close Page::act(const PageMessage& message) {
  if (const auto* ack = std::get_if<Ack>(&message)) {
    if (ack->seq > sent_) return Close::kPolicy;
    acked_ = std::max(acked_, ack->seq);
  } else if (const auto* ping = std::get_if<Ping>(&message)) {
    ping_ = ping->t0;
  } else if (std::holds_alternative<Grab>(message)) {
    grant_ = viewer_.tools.grab(id_);
    rival_told_ = false;
  } else if (const auto* target = std::get_if<Target>(&message)) {
    (void)viewer_.tools.target(id_,
                               target->position);  // false after an ending, which is on its way to the page
  } else if (std::holds_alternative<Release>(message)) {
    viewer_.tools.release(id_);
  } else if (const auto* wanted = std::get_if<SetParameters>(&message)) {
    viewer_.parameters.set(id_, *wanted);
  } else if (const auto* rate = std::get_if<SetRate>(&message)) {
    pace_.setRate(std::min(rate->hz, max_rate_hz_));
  }
  return Close::kNone;
}

void Page::answered(const ParameterDesk::Answer& answer) {
  constexpr std::size_t kMost =
      16;  // one comes per request to the server; bounds those of a page that does not read
  if (answers_.size() >= kMost) answers_.pop_front();
  answers_.push_back(answer);
}

void Page::lookForRival(std::int64_t now_ns) {
  if (rival_told_) return;
  const auto id = viewer_.tools.toolOf(id_);
  const OrganFeed::ToolView* view = id ? viewer_.feed.tool(*id, now_ns) : nullptr;
  if (view == nullptr || (view->force.flags & dds::flag::kTwoPublishers) == 0) return;
  grant_ = ToolGrant{true, *id, "another program sends tool " + std::to_string(*id) + " too"};
  rival_told_ = true;
}

bool Page::meshDue() const {
  return viewer_.feed.surface() != nullptr && mesh_revision_ != viewer_.feed.revision();
}

bool Page::statusDue(std::int64_t now_ns) const {
  const bool news = status_version_ != viewer_.feed.statusVersion();
  return now_ns - status_ns_ >= (news ? kLeastStatusNs : kStatusNs);
}

bool Page::frameDue(std::int64_t now_ns) const {
  if (viewer_.feed.surface() == nullptr || sent_ - acked_ >= kInFlight || !pace_.due(now_ns)) return false;
  return field_version_ != viewer_.feed.fieldVersion() || answer_place_ != viewer_.feed.answers().end() ||
         shown_ != shownTools(now_ns);
}

// After a server is gone neither field nor answer comes, but its tools must leave the page.
std::uint32_t Page::shownTools(std::int64_t now_ns) const {
  std::uint32_t shown = 0;
  for (std::uint32_t id = 0; id < OrganFeed::kTools; ++id)
    if (viewer_.feed.tool(id, now_ns) != nullptr) shown |= 1U << id;
  return shown;
}

bool Page::wants(std::int64_t now_ns) const {
  return hello_ || state_version_ != viewer_.stateVersion() || meshDue() || grant_ || ping_ ||
         !answers_.empty() || statusDue(now_ns) || frameDue(now_ns);
}

std::optional<std::string> Page::nextText(std::int64_t now_ns) {
  if (std::exchange(hello_, false)) return helloText(id_, max_rate_hz_);
  if (state_version_ != viewer_.stateVersion()) {
    state_version_ = viewer_.stateVersion();
    return stateText(viewer_.state());
  }
  if (const auto t0 = std::exchange(ping_, std::nullopt))
    return pongText(*t0, static_cast<double>(rt::monotonicNow()) * 1e-3);
  if (const auto grant = std::exchange(grant_, std::nullopt)) return toolText(*grant);
  if (!answers_.empty()) {
    const ParameterDesk::Answer answer = answers_.front();
    answers_.pop_front();
    return parametersText(answer.request, answer.accepted, answer.message);
  }
  if (meshDue() && mesh_text_revision_ != viewer_.feed.revision()) {
    mesh_text_revision_ = viewer_.feed.revision();
    return meshText(*viewer_.feed.surface(), mesh_text_revision_,
                    viewer_.feed.watch().status()->tip_radius[0]);
  }
  if (!statusDue(now_ns)) return std::nullopt;
  const double seconds = static_cast<double>(now_ns - status_ns_) * 1e-9;
  const double rate = status_ns_ == 0 ? 0.0 : (sent_ - counted_) / seconds;
  status_version_ = viewer_.feed.statusVersion();
  status_ns_ = now_ns;
  counted_ = sent_;
  return statusText(viewer_.feed.watch().status(), viewer_.feed.parameters(),
                    {viewer_.pages().size(), rate, viewer_.feed.droppedFields()});
}

std::optional<bool> Page::next(std::int64_t now_ns, Bytes& out) {
  if (const auto text = nextText(now_ns)) {
    out.insert(out.end(), text->begin(), text->end());
    return false;
  }
  if (meshDue()) {
    mesh_revision_ = viewer_.feed.revision();
    field_version_ = 0;  // the field sent last belongs to the old surface
    encodeMesh(*viewer_.feed.surface(), mesh_revision_, out);
    return true;
  }
  if (!frameDue(now_ns)) return std::nullopt;
  frame(now_ns, out);
  return true;
}

void Page::frame(std::int64_t now_ns, Bytes& out) {
  const bool new_field = field_version_ != viewer_.feed.fieldVersion();
  viewer_.feed.answers().since(answer_place_, kMostAnswers, batch_);
  const std::vector<ToolRecord> records = tools(now_ns);
  shown_ = shownTools(now_ns);
  Frame frame;
  frame.seq = ++sent_;
  frame.mesh_revision = mesh_revision_;
  frame.field = new_field ? viewer_.feed.field() : nullptr;
  frame.tools = records;
  frame.answers = batch_;
  frame.sent_us = static_cast<double>(rt::monotonicNow()) * 1e-3;
  encodeFrame(frame, out);
  field_version_ = viewer_.feed.fieldVersion();
  pace_.went(now_ns);
}

std::vector<ToolRecord> Page::tools(std::int64_t now_ns) const {
  std::vector<ToolRecord> records;
  const auto mine = viewer_.tools.toolOf(id_);
  for (std::uint32_t id = 0; id < OrganFeed::kTools; ++id) {
    const OrganFeed::ToolView* view = viewer_.feed.tool(id, now_ns);
    if (view == nullptr) continue;
    const dds::ToolForce& force = view->force;
    ToolRecord record;
    record.tool_id = id;
    record.state = force.state;
    record.flags = force.flags;
    record.mine = mine == id;
    record.tip = view->tip_known ? narrow(view->tip) : narrow(force.proxy);
    record.proxy = narrow(force.proxy);
    record.anchor = narrow(force.anchor);
    record.force = narrow(force.force);
    record.penetration = static_cast<float>(force.penetration);
    record.domain_radius = static_cast<float>(force.domain_radius);
    records.push_back(record);
  }
  return records;
}

}  // namespace palpate::viewer
