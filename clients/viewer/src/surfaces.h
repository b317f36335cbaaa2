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

/// Rest surfaces of all servers on the domain. Each comes once, before or after its server is followed, so each is copied on
/// arrival. Threads: poll() and the const functions, the web thread.
class Surfaces {
 public:
  static constexpr std::size_t kMostKept = 16;  ///< then the oldest is dropped, but not the followed one
  static constexpr std::size_t kMostNumbers =
      3'000'000;  ///< of positions and of triangles, with those of regions: a million of each
  static constexpr std::size_t kMostRegions = 256;

  /// @throw dds::DdsError
  explicit Surfaces(const dds::Participant& participant);

  /// Takes in what came. @param[in] followed  session of the followed server
  void poll(std::uint64_t followed);

  /// nullptr before it has come. Valid until the next poll().
  [[nodiscard]] const client::Surface* find(std::uint64_t session, std::uint32_t organ_id) const;
  /// Why the newest surface was refused; empty when it was accepted.
  [[nodiscard]] const std::string& refusal() const noexcept { return refusal_; }
  [[nodiscard]] std::string mismatch() const { return reader_.mismatch(); }

  /// A copy of the surface. @throw client::ClientError  it has more than is shown, or is malformed
  [[nodiscard]] static client::Surface bounded(const dds::SurfaceMesh& message);

 private:
  struct Arrived {
    std::uint64_t session{0};
    client::Surface surface;
    std::string refusal;  // empty: there is one
  };
  static bool copy(const dds::SurfaceMesh& message, void* context) noexcept;
  void keep(Arrived arrived, std::uint64_t followed);

  std::mutex mutex_;
  std::vector<Arrived> arrived_;  // DDS's thread adds, poll() takes
  std::deque<Arrived> kept_;      // oldest first
  std::string refusal_;
  dds::Reader<dds::SurfaceMesh> reader_;  // last: its filter stops first
};

}  // namespace palpate::viewer
