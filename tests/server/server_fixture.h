// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "palpate/testing/server_process.h"
#include "palpate/testing/synthetic_model.h"
#include "palpate/testing/test_domain.h"
#include "test_client.h"

namespace palpate::server::testing {

using palpate::testing::ServerProcess;

inline constexpr double kTipRadius = 0.005;
inline constexpr std::int64_t kMs = 1'000'000;

inline void pause(int milliseconds) {
  std::this_thread::sleep_for(std::chrono::milliseconds(milliseconds));
}

inline double sizeOf(const double (&v)[3]) {
  return std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}

inline bool isFinite(const dds::ToolForce& force) {
  return std::isfinite(sizeOf(force.force)) &&
         std::all_of(std::begin(force.stiffness), std::end(force.stiffness),
                     [](double k) { return std::isfinite(k); });
}

inline std::uint64_t gaps(const std::vector<dds::ToolForce>& forces) {
  return forces.back().seq - forces.front().seq + 1 - forces.size();
}

// Largest change of the force from an answer to the next, N per ms; ticks that came late count by their time.
inline double steepest(const std::vector<dds::ToolForce>& forces) {
  double largest = 0.0;
  for (std::size_t i = 1; i < forces.size(); ++i) {
    const double ms = static_cast<double>(forces[i].stamp_ns - forces[i - 1].stamp_ns) / kMs;
    double change[3];
    for (int k = 0; k < 3; ++k) change[k] = forces[i].force[k] - forces[i - 1].force[k];
    largest = std::max(largest, sizeOf(change) / std::max(ms, 1.0));
  }
  return largest;
}

class ServerEndToEnd : public ::testing::Test {
 protected:
  ServerEndToEnd() { palpate::testing::writeSyntheticModel(model_); }
  ~ServerEndToEnd() override {
    client_.reset();
    server_.reset();
  }

  // Server, one client that has found it, and a place to touch. Without a word about the device the tool holds
  // the patch itself and never slides: forces are the model's own.
  void start(std::vector<std::string> more = {}) {
    std::vector<std::string> arguments{"--model", model_.string(), "--domain", std::to_string(domain_)};
    if (std::find(more.begin(), more.end(), "--device") == more.end())
      arguments.insert(arguments.end(), {"--device", "custom", "--friction", "inf"});
    arguments.insert(arguments.end(), more.begin(), more.end());
    server_ = std::make_unique<ServerProcess>(arguments, log_fd_);
    client_ = std::make_unique<TestClient>(domain_, 0, identity_);
    ASSERT_TRUE(client_->connect()) << server_->log();
    const auto target = client_->findTarget();
    ASSERT_TRUE(target.has_value()) << server_->log();
    target_ = *target;
  }

  // Whether the server logs it within some seconds.
  [[nodiscard]] bool logs(const std::string& text, int seconds = 5) const {
    for (int i = 0; i < 50 * seconds; ++i, pause(20))
      if (server_->log().find(text) != std::string::npos) return true;
    return false;
  }

  // Centre of the tip at a depth below the surface; negative is above it.
  [[nodiscard]] Point atDepth(double depth) const {
    return along(target_.position, target_.normal, kTipRadius - depth);
  }

  // From above the surface down to `depth`, and held there until the force has settled.
  void press(double depth) {
    client_->startSending(atDepth(-0.002));
    pause(20);
    client_->moveTo(atDepth(depth), 150);
    pause(150);
    client_->forget();
    settle();
  }

  // `settled_` is an answer to a pose that is sent from now on, of a tick before which the machine had not stood still.
  void settle() {
    constexpr std::uint64_t kPoses = 50;  // until one at rest
    constexpr std::uint32_t kMachineStoodStill = dds::flag::kTickOverrun | dds::flag::kStalePose |
                                                 dds::flag::kRamping | dds::flag::kForceRateLimited |
                                                 dds::flag::kPoseOutOfOrder;
    const auto answer = client_->waitFor([from = client_->sent() + kPoses](const dds::ToolForce& f) {
      return f.pose_seq >= from && (f.flags & kMachineStoodStill) == 0;
    });
    ASSERT_TRUE(answer.has_value()) << server_->log();
    settled_ = *answer;
  }

  std::uint32_t domain_ = palpate::testing::exclusiveDomain();
  const palpate::testing::TemporaryFile model_file_{"e2e.h5"};
  const std::filesystem::path model_ = model_file_.path();
  int log_fd_ = -1;
  std::optional<dds::Identity> identity_;  // of the client
  std::unique_ptr<ServerProcess> server_;
  std::unique_ptr<TestClient> client_;
  Target target_;
  dds::ToolForce settled_{};
};

}  // namespace palpate::server::testing
