// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "core/devices/path/path.h"
#include "palpate/client/gap_counter.h"
#include "palpate/client/server_hold.h"
#include "palpate/client/surface.h"
#include "palpate/idl/reader.h"

namespace palpate::watch {

/// The displacement of one node.
struct NodeDisplacement {
  std::size_t node{0};
  device::Point u{};  ///< m
  double size{0.0};   ///< m
};

/// Summary of the fields since the log began.
struct FieldSummary {
  std::uint64_t received{0};
  std::uint64_t superseded{
      0};                    ///< sent by the server but replaced, lost, or not admitted before they came here
  std::uint64_t refused{0};  ///< of another model, of another size, or with a number that is not finite
  std::uint64_t left_out{0};                       ///< of another server
  NodeDisplacement largest;                        ///< of the newest field
  NodeDisplacement peak;                           ///< of all fields so far of the surface below
  std::shared_ptr<const client::Surface> surface;  ///< whose nodes these are
  std::uint64_t model_changes{0};                  ///< how often it became another one
};

/// Follows an organ's displacement field, of one server as long as that sends. Threads: take() on the receive thread, the rest on one other; they
/// share a lock. Real-time: no.
class FieldLog {
 public:
  explicit FieldLog(std::shared_ptr<const client::Surface> surface);
  static constexpr std::int64_t kSilenceNs = 2'500'000'000;  ///< a server sends a field each second at least

  /// Whether it is this run's fields that are followed. Threads: any
  [[nodiscard]] bool holds(std::uint64_t session) const noexcept { return hold_.held().session == session; }

  /// The server took another model: fields of this surface are followed from now on.
  void change(std::shared_ptr<const client::Surface> surface);

  void take(dds::ReaderView<dds::SurfaceDisplacement> reader) noexcept;

  [[nodiscard]] FieldSummary summary() const;
  /// The field with the largest displacement so far, 3 Ns, m; zero before the first field.
  [[nodiscard]] std::vector<float> peakField() const;

 private:
  [[nodiscard]] bool fits(const dds::SurfaceDisplacement& field) const noexcept;
  void add(const dds::SurfaceDisplacement& field) noexcept;

  mutable std::mutex mutex_;
  std::shared_ptr<const client::Surface> surface_;
  std::uint64_t model_changes_{0};
  client::ServerHold hold_;
  client::GapCounter fields_;
  std::uint64_t refused_{0};
  NodeDisplacement largest_;
  NodeDisplacement peak_;
  std::vector<float> peak_field_;
};

}  // namespace palpate::watch
