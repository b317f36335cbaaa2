// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <chrono>
#include <memory>
#include <thread>

namespace palpate::faults {

/// An Ethernet interface of the calling thread's network namespace, 10.77.0.`host`, whose frames this process reads and writes (a TAP
/// device). It lasts as long as this.
class NetworkEnd {
 public:
  /// @return null where none may be made
  [[nodiscard]] static std::unique_ptr<NetworkEnd> make(const char* name, int host);
  ~NetworkEnd();
  NetworkEnd(const NetworkEnd&) = delete;
  NetworkEnd& operator=(const NetworkEnd&) = delete;
  [[nodiscard]] int descriptor() const noexcept { return descriptor_; }

 private:
  explicit NetworkEnd(int descriptor) : descriptor_(descriptor) {}
  int descriptor_;
};

/// What lies between two ends: a thread hands each frame on, and loses or delays it as told, the same both ways.
class EmulatedNetwork {
 public:
  EmulatedNetwork(std::unique_ptr<NetworkEnd> one, std::unique_ptr<NetworkEnd> other);
  ~EmulatedNetwork();
  EmulatedNetwork(const EmulatedNetwork&) = delete;
  EmulatedNetwork& operator=(const EmulatedNetwork&) = delete;

  /// @param[in] share  of the frames, 0 to 1
  void lose(double share) noexcept { lost_ = share; }
  void delay(std::chrono::milliseconds time) noexcept { delay_ = time; }

 private:
  void run();

  std::unique_ptr<NetworkEnd> ends_[2];
  std::atomic<double> lost_{0.0};
  std::atomic<std::chrono::milliseconds> delay_{std::chrono::milliseconds(0)};
  std::atomic<bool> stopping_{false};
  std::thread thread_;
};

}  // namespace palpate::faults
