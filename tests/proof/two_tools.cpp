// SPDX-License-Identifier: Apache-2.0
#include "two_tools.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace palpate::proof {
namespace {

constexpr double kApart = 0.020;   // m
constexpr double kCircle = 0.004;  // radius, m
constexpr double kRound = 0.7;     // s for one
constexpr double kDepth = 0.002;   // m
constexpr double kAbove = 0.003;   // m, when lifted
constexpr double kLift = 2.0;      // s from one lift to the next,
constexpr double kLifted = 0.3;    // of which it takes so many

// -kAbove to kDepth, without a jump.
double depthAt(double seconds) {
  const double in_lift = std::fmod(seconds, kLift);
  if (in_lift > kLifted) return kDepth;
  const double share = 0.5 * (1.0 - std::cos(2.0 * std::numbers::pi * in_lift / kLifted));
  return kDepth - share * (kDepth + kAbove);
}

}  // namespace

TwoTools::TwoTools(const MetaModel& model, std::uint32_t domain, double tip_radius)
    : model_(model),
      tip_radius_(tip_radius),
      participant_(domain),
      poses_(participant_),
      forces_(participant_, &TwoTools::onForce, this),
      status_(participant_),
      fields_(participant_) {
  findPlaces();
  constexpr std::chrono::seconds kLong{20};
  if (!poses_.waitForReaders(1, kLong) || !forces_.waitForWriters(1, kLong))
    throw std::runtime_error("the server was not found on DDS domain " + std::to_string(domain));
}

TwoTools::~TwoTools() {
  stopping_ = true;
  if (sender_.joinable()) sender_.join();
}

TwoTools::Place TwoTools::placeAt(int node) const {
  const Vec3 n = model_.surface().nodeNormal(node);
  const Vec3 one = n.unitOrthogonal();
  return {model_.surface().position(model_.surface().atNode(node)), {one, n.cross(one)}};
}

// The accessible node that lies most toward +z, and of those that look the same way the one nearest to kApart from it.
void TwoTools::findPlaces() {
  const ModelView& view = model_.view();
  std::vector<int> nodes;
  for (std::size_t i = 0; i < view.positions(); ++i)
    if (view.contact_accessible[i] != 0) nodes.push_back(view.contact_node[i]);
  if (nodes.size() < 2) throw std::runtime_error("the model has no two places that may be touched");
  const auto at = [&](int node) { return model_.surface().position(model_.surface().atNode(node)); };
  const int first =
      *std::max_element(nodes.begin(), nodes.end(), [&](int a, int b) { return at(a).z() < at(b).z(); });
  const auto misfit = [&](int node) {
    const bool turned = model_.surface().nodeNormal(node).dot(model_.surface().nodeNormal(first)) < 0.5;
    return std::abs((at(node) - at(first)).norm() - kApart) + (turned ? 1.0 : 0.0);
  };
  const int second =
      *std::min_element(nodes.begin(), nodes.end(), [&](int a, int b) { return misfit(a) < misfit(b); });
  places_ = {placeAt(first), placeAt(second)};
}

Vec3 TwoTools::tipAt(const Place& place, double seconds) const {
  const double angle = 2.0 * std::numbers::pi * seconds / kRound;
  const Vec3 beside =
      place.centre + kCircle * (std::cos(angle) * place.way[0] + std::sin(angle) * place.way[1]);
  const NearestPoint nearest = model_.surface().closestPoint(beside);
  return nearest.position + (tip_radius_ - depthAt(seconds)) * model_.surface().normal(nearest.s);
}

void TwoTools::start() {
  sender_ = std::thread([this] { send(); });
}

void TwoTools::send() {
  using Clock = std::chrono::steady_clock;
  const Clock::time_point begin = Clock::now();
  Clock::time_point next = begin;
  for (std::uint64_t seq = 1; !stopping_; ++seq) {
    for (std::uint32_t tool = 0; tool < 2; ++tool) {
      const double seconds = std::chrono::duration<double>(Clock::now() - begin).count() + 0.5 * tool;
      const Vec3 tip = tipAt(places_[tool], seconds);
      dds::ToolPose pose{};
      pose.tool_id = tool;
      pose.seq = seq;
      pose.stamp_ns = std::chrono::nanoseconds(Clock::now().time_since_epoch()).count();
      std::copy(tip.begin(), tip.end(), pose.position);
      pose.orientation[3] = 1.0;
      (void)poses_.write(pose);
    }
    next = std::max(next + std::chrono::milliseconds(1), Clock::now());
    std::this_thread::sleep_until(next);
  }
}

void TwoTools::onForce(dds::ReaderView<dds::ToolForce> reader, void* context) noexcept {
  auto& self = *static_cast<TwoTools*>(context);
  std::array<dds::ToolForce, dds::kMaxTake> samples;
  const std::size_t count = reader.take(samples);
  for (std::size_t i = 0; i < count; ++i) {
    if (samples[i].tool_id > 1) continue;
    auto& answers = self.answers_[samples[i].tool_id];
    ++answers[0];
    if ((samples[i].flags & dds::flag::kInContact) != 0) ++answers[1];
    if (samples[i].state == dds::tool_state::kSlide) ++answers[2];
    if (samples[i].state == dds::tool_state::kFree) ++answers[3];
  }
}

std::optional<dds::ServerStatus> TwoTools::status() {
  for (int i = 0; i < 1000; ++i) {
    dds::ServerStatus status;
    if (status_.take({&status, 1}) == 1) return status;
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  return std::nullopt;
}

std::uint64_t TwoTools::newestField() {
  const auto samples = fields_.takeLoaned();
  return samples.empty() ? 0 : samples[samples.size() - 1].seq;
}

std::array<Answers, 2> TwoTools::take() {
  std::array<Answers, 2> out;
  for (std::size_t tool = 0; tool < 2; ++tool) {
    auto& from = answers_[tool];
    out[tool] = {from[0].exchange(0), from[1].exchange(0), from[2].exchange(0), from[3].exchange(0)};
  }
  return out;
}

}  // namespace palpate::proof
