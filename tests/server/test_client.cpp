// SPDX-License-Identifier: Apache-2.0
#include "test_client.h"

#include <chrono>
#include <cmath>
#include <ctime>

namespace palpate::server::testing {
namespace {

constexpr auto kTick = std::chrono::milliseconds(1);

Point node(const dds::SurfaceMesh& mesh, std::uint32_t index) {
  const double* const at = mesh.positions._buffer + 3 * static_cast<std::size_t>(index);
  return {at[0], at[1], at[2]};
}

// Twice the area of the triangle times its outward normal.
Point areaVector(const Point& a, const Point& b, const Point& c) {
  const Point u = along(b, a, -1.0);
  const Point v = along(c, a, -1.0);
  return {u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
}

std::uint32_t highestAccessible(const dds::SurfaceMesh& mesh) {
  std::uint32_t best = 0;
  double height = -1e300;
  for (std::uint32_t i = 0; i < mesh.accessible._length; ++i) {
    if (mesh.accessible._buffer[i] == 0 || node(mesh, i)[2] <= height) continue;
    best = i;
    height = node(mesh, i)[2];
  }
  return best;
}

Point outwardNormal(const dds::SurfaceMesh& mesh, std::uint32_t at) {
  Point sum{};
  for (std::uint32_t t = 0; t + 2 < mesh.triangles._length; t += 3) {
    const std::uint32_t* const corner = mesh.triangles._buffer + t;
    if (corner[0] != at && corner[1] != at && corner[2] != at) continue;
    sum = along(sum, areaVector(node(mesh, corner[0]), node(mesh, corner[1]), node(mesh, corner[2])), 1.0);
  }
  const double size = std::sqrt(sum[0] * sum[0] + sum[1] * sum[1] + sum[2] * sum[2]);
  return {sum[0] / size, sum[1] / size, sum[2] / size};
}

std::int64_t senderNow() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(
             std::chrono::steady_clock::now().time_since_epoch())
      .count();
}

}  // namespace

TestClient::TestClient(std::uint32_t domain, std::uint32_t tool_id, std::optional<dds::Identity> identity)
    : tool_id_(tool_id),
      participant_(domain, std::move(identity)),
      poses_(participant_),
      announcements_(participant_),
      surface_(participant_),
      displacement_(participant_),
      status_(participant_),
      answers_(participant_, &TestClient::onForce, this) {}

TestClient::~TestClient() {
  stopSending();
}

std::optional<Target> TestClient::findTarget() {
  for (int i = 0; i < 1000; ++i) {
    const auto samples = surface_.takeLoaned();
    if (!samples.empty()) {
      const dds::SurfaceMesh& mesh = samples[0];
      const std::uint32_t best = highestAccessible(mesh);
      return Target{node(mesh, best), outwardNormal(mesh, best), mesh.positions._length / 3};
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  return std::nullopt;
}

bool TestClient::connect() {
  return poses_.waitForReaders(1, std::chrono::seconds(20)) &&
         answers_.waitForWriters(1, std::chrono::seconds(20));
}

void TestClient::startSending(const Point& position) {
  position_ = position;
  sending_ = true;
  sender_ = std::thread([this] { sendLoop(); });
}

void TestClient::stopSending() {
  sending_ = false;
  if (sender_.joinable()) sender_.join();
}

void TestClient::sendLoop() {
  auto next = std::chrono::steady_clock::now();
  while (sending_) {
    Point position;
    {
      const std::lock_guard lock(mutex_);
      position = position_;
    }
    send(poseAt(position));
    next = std::max(next + kTick, std::chrono::steady_clock::now());
    std::this_thread::sleep_until(next);
  }
}

void TestClient::moveTo(const Point& position, int milliseconds) {
  const Point from = position_;
  for (int i = 1; i <= milliseconds; ++i) {
    {
      const std::lock_guard lock(mutex_);
      const double part = static_cast<double>(i) / milliseconds;
      for (std::size_t k = 0; k < 3; ++k) position_[k] = from[k] + part * (position[k] - from[k]);
    }
    std::this_thread::sleep_for(kTick);
  }
}

dds::ToolPose TestClient::poseAt(const Point& position) const {
  dds::ToolPose pose{};
  pose.server_id = dds::kServerAny;
  pose.tool_id = tool_id_;
  for (std::size_t k = 0; k < 3; ++k) pose.position[k] = position[k];
  pose.orientation[3] = 1.0;
  return pose;
}

void TestClient::send(dds::ToolPose pose) {
  if (pose.seq == 0) pose.seq = ++seq_;
  if (pose.stamp_ns == 0) pose.stamp_ns = senderNow();
  (void)poses_.write(pose);
}

std::vector<dds::ToolForce> TestClient::forces() const {
  const std::lock_guard lock(mutex_);
  return forces_;
}

std::vector<dds::ToolForce> TestClient::forcesOfOtherTools() const {
  const std::lock_guard lock(mutex_);
  return other_forces_;
}

void TestClient::forget() {
  const std::lock_guard lock(mutex_);
  forces_.clear();
}

std::size_t TestClient::waitForDisplacement(double size) {
  for (int i = 0; i < 2000; ++i) {
    const auto samples = displacement_.takeLoaned();
    for (std::size_t s = 0; s < samples.size(); ++s) {
      const auto& field = samples[s].displacement;
      for (std::uint32_t k = 0; k < field._length; ++k) {
        if (std::abs(static_cast<double>(field._buffer[k])) >= size) return field._length;
      }
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  return 0;
}

void TestClient::onForce(dds::ReaderView<dds::ToolForce> reader, void* context) noexcept {
  auto& self = *static_cast<TestClient*>(context);
  std::array<dds::ToolForce, dds::kMaxTake> samples;
  const std::size_t count = reader.take(samples);
  const std::lock_guard lock(self.mutex_);
  for (std::size_t i = 0; i < count; ++i) {
    auto& list = samples[i].tool_id == self.tool_id_ ? self.forces_ : self.other_forces_;
    list.push_back(samples[i]);
  }
}

}  // namespace palpate::server::testing
