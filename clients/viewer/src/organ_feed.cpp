// SPDX-License-Identifier: Apache-2.0
#include "organ_feed.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>

#include "narrow.h"
#include "palpate/idl/printable.h"

namespace palpate::viewer {
namespace {

double sizeOf(const double (&v)[3]) {
  return std::hypot(v[0], v[1], v[2]);
}

device::Point pointOf(const double (&v)[3]) {
  return {{v[0], v[1], v[2]}};
}

// -n.K n: rise of the organ's push per metre along the normal.
double normalStiffness(const dds::ToolForce& force, const device::Point& n) {
  double sum = 0.0;
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) sum -= n[i] * force.stiffness[3 * i + j] * n[j];
  return force.state == dds::tool_state::kFree ? 0.0 : sum;
}

bool isShowable(const dds::ToolPose& pose) noexcept {
  constexpr double kFurthest = 1e6;  // m: larger than any organ; pages get float32
  return pose.tool_id < OrganFeed::kTools && std::all_of(std::begin(pose.position), std::end(pose.position),
                                                         [](double x) { return std::fabs(x) <= kFurthest; });
}

// The tool's poses stopped and its force is zero: the server goes on answering, but no hand holds the tool.
bool isGhost(const dds::ToolForce& force) {
  return (force.flags & dds::flag::kStalePose) != 0 && sizeOf(force.force) == 0.0;
}

bool sameSurface(const client::Surface& a, const client::Surface& b) {
  return a.organ_id == b.organ_id && a.model_id == b.model_id && a.topology_revision == b.topology_revision &&
         a.positions.size() == b.positions.size() && a.triangles.size() == b.triangles.size();
}

}  // namespace

OrganFeed::OrganFeed(const dds::Participant& participant, const client::WantedServer& wanted, double rate_hz,
                     WakeFunction wake, void* context)
    : rate_hz_(rate_hz),
      watch_(participant.domain(), wanted),
      statuses_(participant),
      parameter_answers_(participant),
      surfaces_(participant),
      poses_(participant, nullptr, this, &OrganFeed::admitsPose),
      arrivals_(participant, rate_hz, wake, context) {}

std::vector<std::uint32_t> OrganFeed::poll(std::int64_t now_ns, dds::WriterId own_writer) {
  pollServer(now_ns);
  surfaces_.poll(watch_.session());
  selectSurface();
  pollField();
  pollForces();
  return pollPoses(own_writer);
}

void OrganFeed::pollServer(std::int64_t now_ns) {
  for (const client::HeardStatus& heard : statuses_.heardAfter(heard_ns_)) {
    heard_ns_ = heard.heard_ns;
    const std::uint64_t followed = watch_.session();
    if (!watch_.saw(heard.status, now_ns, heard.writer)) continue;
    ++status_version_;
    followed_id_.store(heard.status.server_id, std::memory_order_relaxed);
    followed_answers_any_.store(heard.status.answers_any, std::memory_order_relaxed);
    if (followed != heard.status.session) follow(heard.status.session);
  }
  lookForMismatch(now_ns);
  std::array<dds::ServerParameters, dds::kMaxTake> answers;
  const std::size_t answered = parameter_answers_.take(answers);
  for (std::size_t i = 0; i < answered; ++i) keepParameters(answers[i]);
}

// Once a second while there is no server: it looks at all that DDS discovered.
void OrganFeed::lookForMismatch(std::int64_t now_ns) {
  constexpr std::int64_t kPause = 1'000'000'000;
  if (watch_.status() || now_ns - looked_ns_ < kPause) return;
  looked_ns_ = now_ns;
  std::string mismatch = statuses_.mismatch();
  if (mismatch.empty()) mismatch = surfaces_.mismatch();
  if (!mismatch.empty() && mismatch != mismatch_) spdlog::warn(mismatch);
  mismatch_ = std::move(mismatch);
}

// Nothing of the run before is left.
void OrganFeed::follow(std::uint64_t session) {
  arrivals_.follow(session);
  stamp_clock_ = StampClock();
  tools_ = {};
  has_field_ = false;
}

// Also of a server that is not followed yet: parameters come once.
void OrganFeed::keepParameters(const dds::ServerParameters& parameters) {
  constexpr std::size_t kMostServers = 64;
  if (parameters_.size() >= kMostServers && !parameters_.contains(parameters.session))
    std::erase_if(parameters_, [&](const auto& kept) { return kept.first != watch_.session(); });
  parameters_[parameters.session] = parameters;
  new_parameters_.push_back(parameters);
  ++status_version_;
}

std::optional<dds::ServerParameters> OrganFeed::parameters() const {
  const auto at = watch_.status() ? parameters_.find(watch_.session()) : parameters_.end();
  return at == parameters_.end() ? std::nullopt : std::optional(at->second);
}

const client::Surface* OrganFeed::followedSurface() const {
  const auto& status = watch_.status();
  return status ? surfaces_.find(status->session, status->organ_id) : nullptr;
}

void OrganFeed::selectSurface() {
  const client::Surface* wanted = followedSurface();
  if (wanted == nullptr || wanted->model_id != watch_.status()->model_id) return;
  if (revision_ > 0 && sameSurface(surface_, *wanted)) return;
  surface_ = *wanted;
  outward_ = Outward(surface_);
  has_field_ = false;
  ++revision_;
  spdlog::info("surface of model {}: {} nodes, {} triangles", dds::printable(surface_.model_id.c_str()),
               surface_.positions.size(), surface_.triangles.size());
}

bool OrganFeed::fits(const ArrivedField& field) const {
  return revision_ > 0 && field.session == watch_.session() && field.model_id == surface_.model_id &&
         field.organ_id == surface_.organ_id && field.topology_revision == surface_.topology_revision &&
         field.displacement.size() == 3 * surface_.positions.size() &&
         std::all_of(field.displacement.begin(), field.displacement.end(),
                     [](float u) { return std::isfinite(u); });
}

void OrganFeed::pollField() {
  if (!arrivals_.takeField(arrived_)) return;
  if (!fits(arrived_)) {
    ++dropped_fields_;
    return;
  }
  field_ = encodeField(arrived_.displacement);
  field_.mesh_revision = revision_;
  field_.seq = arrived_.seq;
  field_.sample_us = static_cast<double>(arrived_.received_ns) * 1e-3;
  has_field_ = true;
  ++field_version_;
}

void OrganFeed::pollForces() {
  arrivals_.takeForces(forces_);
  for (const TimedForce& timed : forces_) {
    if (timed.force.session != watch_.session()) continue;  // it came before the next server was followed
    ToolView& view = tools_[timed.force.tool_id];
    const bool same_anchor =
        view.received_ns != 0 && std::equal(std::begin(view.force.anchor), std::end(view.force.anchor),
                                            std::begin(timed.force.anchor));
    view.force = timed.force;
    view.received_ns = timed.received_ns;
    if (!same_anchor) view.normal = outward_.at(pointOf(timed.force.anchor));
    if (!isGhost(timed.force)) addAnswer(timed);
  }
}

void OrganFeed::addAnswer(const TimedForce& timed) {
  const dds::ToolForce& force = timed.force;
  AnswerRecord answer;
  answer.tool_id = force.tool_id;
  answer.flags = force.flags;
  answer.t_us = static_cast<double>(stamp_clock_.toLocal(force.stamp_ns, timed.received_ns)) * 1e-3;
  answer.force = static_cast<float>(sizeOf(force.force));
  answer.penetration = static_cast<float>(force.penetration);
  answer.wakeup_us = static_cast<float>(static_cast<double>(force.wakeup_ns) * 1e-3);
  const ToolView& view = tools_[force.tool_id];
  answer.stiffness = static_cast<float>(normalStiffness(force, view.normal));
  answer.force_vector = narrow(pointOf(force.force));
  if (view.tip_known) answer.tip = narrow(view.tip);
  answers_.add(answer);
}

bool OrganFeed::addressesFollowed(const dds::ToolPose& pose) const noexcept {
  return pose.server_id == dds::kServerAny ? followed_answers_any_.load(std::memory_order_relaxed)
                                           : pose.server_id == followed_id_.load(std::memory_order_relaxed);
}

// On DDS's receive thread: ids that somebody invents, of servers or tools, take no place in the reader.
bool OrganFeed::admitsPose(const dds::ToolPose& pose, void* context) noexcept {
  return isShowable(pose) && static_cast<const OrganFeed*>(context)->addressesFollowed(pose);
}

std::vector<std::uint32_t> OrganFeed::pollPoses(dds::WriterId own_writer) {
  std::array<dds::ToolPose, dds::kMaxTake> poses;
  std::array<dds::WriterId, dds::kMaxTake> writers{};
  const std::size_t count = poses_.view().take(poses, writers);
  std::vector<std::uint32_t> foreign;
  for (std::size_t i = 0; i < count; ++i) {
    if (!addressesFollowed(poses[i])) continue;
    ToolView& view = tools_[poses[i].tool_id];
    view.tip = pointOf(poses[i].position);
    view.tip_known = true;
    if (writers[i] != own_writer) foreign.push_back(poses[i].tool_id);
  }
  return foreign;
}

const OrganFeed::ToolView* OrganFeed::tool(std::uint32_t id, std::int64_t now_ns) const noexcept {
  const ToolView& view = tools_[id];
  const bool shown =
      view.received_ns != 0 && now_ns - view.received_ns < kToolShownNs && !isGhost(view.force);
  return shown ? &view : nullptr;
}

ServerState OrganFeed::state(std::int64_t now_ns) const {
  const client::Surface* wanted = followedSurface();
  ServerState state = watch_.state(now_ns, wanted != nullptr ? wanted->model_id : "", mismatch_);
  if (state.name == "waiting" && !surfaces_.refusal().empty()) state.text = surfaces_.refusal();
  return state;
}

}  // namespace palpate::viewer
