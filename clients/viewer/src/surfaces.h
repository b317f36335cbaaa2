// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

#include "palpate/client/surface.h"
#include "palpate/idl/reader.h"

namespace palpate::viewer {

/// Rest surfaces of all organs and models on the domain. Each comes once, and DDS keeps only one per organ id. Two servers
/// with different models may share an id, so each surface is copied on arrival. Threads: poll() and the const functions,
/// the web thread.
class Surfaces {
 public:
  static constexpr std::size_t kMostKept = 16;  ///< then the oldest is dropped, but not the followed one
  static constexpr std::size_t kMostNumbers =
      3'000'000;  ///< of positions and of triangles: a million of each

  /// @throw dds::DdsError
  explicit Surfaces(const dds::Participant& participant);

  /// Takes in what came. @param[in] organ_id, model_id  of the followed surface
  void poll(std::uint32_t organ_id, std::string_view model_id);

  /// nullptr before it has come. Valid until the next poll().
  [[nodiscard]] const client::Surface* find(std::uint32_t organ_id, std::string_view model_id) const;
  /// Model of the organ's newest surface; empty before the first.
  [[nodiscard]] std::string anyModel(std::uint32_t organ_id) const;
  /// Why the newest surface was refused; empty when it was accepted.
  [[nodiscard]] const std::string& refusal() const noexcept { return refusal_; }
  [[nodiscard]] std::string mismatch() const { return reader_.mismatch(); }

  /// A copy of the surface. @throw client::ClientError  it has more than kMostNumbers, or is malformed
  [[nodiscard]] static client::Surface bounded(const dds::SurfaceMesh& message);

 private:
  struct Arrived {
    client::Surface surface;
    std::string refusal;  // empty: there is one
  };
  static bool copy(const dds::SurfaceMesh& message, void* context) noexcept;
  void keep(client::Surface surface, std::uint32_t organ_id, std::string_view model_id);

  std::mutex mutex_;
  std::vector<Arrived> arrived_;      // DDS's thread adds, poll() takes
  std::deque<client::Surface> kept_;  // oldest first
  std::string refusal_;
  dds::Reader<dds::SurfaceMesh> reader_;  // last: its filter stops first
};

}  // namespace palpate::viewer
