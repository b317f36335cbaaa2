// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <optional>
#include <thread>

#include "core/model/meta_model.h"
#include "palpate/idl/reader.h"
#include "palpate/idl/writer.h"

namespace palpate::proof {

/// What the server answered to one tool.
struct Answers {
  std::uint64_t all{0};
  std::uint64_t in_contact{0};
  std::uint64_t sliding{0};
  std::uint64_t free{0};
};

/// Two tools, 20 mm apart, that press 2 mm deep, go round in circles of 8 mm so that they slide, and every two seconds
/// lift off and come back: a client of its own with the poses of both at 1 kHz.
class TwoTools {
 public:
  /// Finds two places of the model that may be touched, and the server. @throw std::runtime_error when there are none
  TwoTools(const MetaModel& model, std::uint32_t domain, double tip_radius);
  ~TwoTools();
  TwoTools(const TwoTools&) = delete;
  TwoTools& operator=(const TwoTools&) = delete;

  /// Begins to send.
  void start();
  /// What the server says of itself, or nothing when it says nothing for 10 s.
  [[nodiscard]] std::optional<dds::ServerStatus> status();
  /// The counter of the newest field; 0: none came since the last call.
  [[nodiscard]] std::uint64_t newestField();
  /// What came back since the last call, by tool.
  [[nodiscard]] std::array<Answers, 2> take();

 private:
  struct Place {
    Vec3 centre;              // on the surface, m
    std::array<Vec3, 2> way;  // unit, along the surface
  };
  static void onForce(dds::ReaderView<dds::ToolForce> reader, void* context) noexcept;
  [[nodiscard]] Place placeAt(int node) const;
  void findPlaces();
  [[nodiscard]] Vec3 tipAt(const Place& place, double seconds) const;
  void send();

  const MetaModel& model_;
  double tip_radius_;
  std::array<Place, 2> places_;
  std::array<std::array<std::atomic<std::uint64_t>, 4>, 2>
      answers_{};  // the fields of Answers, in their order
  dds::Participant participant_;
  dds::Writer<dds::ToolPose> poses_;
  dds::Reader<dds::ToolForce> forces_;
  dds::Reader<dds::ServerStatus> status_;
  dds::Reader<dds::SurfaceDisplacement> fields_;  // so that the server evaluates them
  std::atomic<bool> stopping_{false};
  std::thread sender_;
};

}  // namespace palpate::proof
