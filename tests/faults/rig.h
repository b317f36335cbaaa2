// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "fault_table.h"
#include "palpate/rt/clock.h"
#include "palpate/testing/server_process.h"
#include "palpate/testing/stalls.h"
#include "palpate/testing/synthetic_model.h"
#include "palpate/testing/test_domain.h"
#include "trace.h"

namespace palpate::faults {

using palpate::testing::ServerProcess;
using std::chrono::milliseconds;

/// Nanoseconds in milliseconds.
inline double ms(std::int64_t ns) {
  return 1e-6 * static_cast<double>(ns);
}

/// The promise: how long after a fault a force may be left, ms (docs/faults.md).
inline constexpr double kZeroWithin = 50.0;
/// A message that was on its way when a thread got stuck still counts, and a thread at its pace may be late by half a period.
inline constexpr double kOnTheWay = 1.5;  // ms

void wait(milliseconds time);

/// palpate-server, fault_device that presses its organ, and what that renders.
class Fault : public ::testing::Test {
 protected:
  Fault();
  ~Fault() override;

  /// The model's own force; and the server listens for others as one does that no test starts.
  void useArguments(const std::vector<std::string>& more = {});
  /// Starts what is missing, and waits until the force is that of the organ.
  void start(const std::vector<std::string>& more = {});
  void startServer();
  void startDevice(const std::vector<std::string>& more = {});
  void waitUntilSettled();

  /// Makes a fault, waits until the force is right again, and tells what came of it. A try that missed a bound is made again: it counts
  /// when this machine's own stalls do not explain it, and three that count are a failure. Where no try can be judged, the test skips. A
  /// force that grows or pulls is a failure at once.
  /// @param[in] inject  returns at the fault's end
  /// @param[in] lasts   how long the force may stay away after that, ms
  enum class Force { kGoesOn, kZero, kEither };
  void expect(const std::string& fault, Force wanted, const std::function<void()>& inject, double lasts);

  /// From `from_ns` on. @param[in] end_ns  the fault's end
  [[nodiscard]] Outcome judge(std::int64_t from_ns, std::int64_t end_ns) const;
  [[nodiscard]] std::vector<Sample> samplesSince(std::int64_t ns) const;

  const std::uint32_t domain_ = palpate::testing::exclusiveDomain();
  const palpate::testing::TemporaryFile model_{"faults.h5"};
  int trace_file_;
  Trace* trace_;
  double before_{0.0};                        // size of the settled force, N
  std::optional<double> recording_lacks_ms_;  // at its end, as inject() found it
  std::optional<double>
      server_zero_ms_;             // the server's force, as inject() found it: judged in the device's place
  std::function<void()> prepare_;  // before each try
  std::function<std::string()> also_;  // @return a complaint about what was read
  std::unique_ptr<palpate::testing::Stalls> stalls_;
  std::vector<std::string> server_arguments_;
  std::unique_ptr<ServerProcess> server_;
  palpate::testing::CaughtOutput device_log_;
  std::unique_ptr<palpate::testing::ChildProcess> device_;

 private:
  // What went wrong in a try.
  struct Complaint {
    std::string text;       // empty: nothing
    double explained_by{};  // ms of this machine's stalls
    std::int64_t from_ns{};
    std::int64_t until_ns{};
    bool harms{false};  // a force that nobody may ever feel: no other try makes it good
  };

  [[nodiscard]] bool isRight(const Sample& sample) const;
  [[nodiscard]] bool isRightSince(std::int64_t ns) const;
  [[nodiscard]] bool bothRun() const;
  void waitUntilRight(std::int64_t end_ns) const;
  [[nodiscard]] Complaint complaint(const Outcome& outcome, Force wanted, double lasts, std::int64_t from_ns,
                                    std::int64_t end_ns) const;
};

}  // namespace palpate::faults
