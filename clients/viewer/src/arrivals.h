// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

#include "palpate/client/frame_pace.h"
#include "palpate/idl/reader.h"

namespace palpate::viewer {

/// Called on DDS's receive thread; must not block.
using WakeFunction = void (*)(void* context) noexcept;

/// A displacement field as it came, unchecked.
struct ArrivedField {
  std::uint64_t session{0};
  std::uint32_t organ_id{0};
  std::string model_id;
  std::uint32_t topology_revision{0};
  std::uint64_t seq{0};
  std::int64_t received_ns{0};
  std::vector<float> displacement;
};

struct TimedForce {
  dds::ToolForce force;
  std::int64_t received_ns;
};

/// Takes what comes often from DDS's threads to the web thread: the newest field, and all forces. Both sides hold a lock
/// for the time of a copy.
class Arrivals {
 public:
  static constexpr std::size_t kMostForces = 8192;        ///< kept until the next takeForces()
  static constexpr std::size_t kMostNumbers = 3'000'000;  ///< of a field; longer ones are ignored

  /// @throw dds::DdsError
  Arrivals(const dds::Participant& participant, double rate_hz, WakeFunction wake, void* context);

  /// Takes at most this many fields per second. Threads: any.
  void setRate(double rate_hz) noexcept { rate_hz_.store(rate_hz, std::memory_order_relaxed); }

  /// Takes only what this run of a server sends; nothing before the first call. Threads: any.
  void follow(std::uint64_t session) noexcept { session_.store(session, std::memory_order_relaxed); }

  /// The newest field, if one came since the last call. Threads: one.
  [[nodiscard]] bool takeField(ArrivedField& field);
  /// Forces since the last call. @param[out] forces  replaced
  void takeForces(std::vector<TimedForce>& forces);

 private:
  static bool admits(const dds::SurfaceDisplacement& field, void* context) noexcept;
  static bool admitsForce(const dds::ToolForce& force, void* context) noexcept;
  static void onField(dds::ReaderView<dds::SurfaceDisplacement> reader, void* context) noexcept;
  static void onForce(dds::ReaderView<dds::ToolForce> reader, void* context) noexcept;
  void keep(const dds::SurfaceDisplacement& field, std::int64_t now_ns);

  WakeFunction wake_;
  void* context_;
  std::atomic<double> rate_hz_;
  std::atomic<std::uint64_t> session_{0};  // 0: none yet
  client::FramePace pace_;                 // the filter's only
  std::mutex mutex_;
  ArrivedField field_;
  bool fresh_{false};
  std::vector<TimedForce> forces_;
  dds::Reader<dds::SurfaceDisplacement> field_reader_;
  dds::Reader<dds::ToolForce> force_reader_;
};

}  // namespace palpate::viewer
