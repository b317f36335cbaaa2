// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <mutex>
#include <string>
#include <vector>

#include "palpate/client/status_board.h"
#include "palpate/idl/process_of.h"
#include "palpate/idl/tap.h"

namespace palpate::list {

/// What is told of an organ's rest surface; the surface itself is not kept.
struct Organ {
  std::uint32_t organ_id{0};
  std::uint64_t session{0};  ///< of its server
  std::string model_id;
  std::size_t nodes{0}, triangles{0}, accessible{0};
  std::array<double, 3> size{};  ///< of the box around it, along x, y, z, m
  struct Region {
    std::string name;
    double youngs_modulus{0.0};  ///< E of the model, Pa
  };
  std::vector<Region> regions;  ///< empty: one material
};

/// A writer of poses and what came from it for one tool.
struct Publisher {
  bool sends{false};  ///< false: it has sent nothing, and the next two say nothing
  std::uint32_t tool_id{0};
  std::uint32_t server_id{0};  ///< which server is meant; dds::kServerAny: whichever answers
  std::uint64_t poses{0};
  double rate_hz{0.0};  ///< 0 where one pose came
  dds::Process process;
};

/// A server, its organ, and for which device each tool is set.
struct Server {
  dds::ServerStatus status{};
  std::vector<Organ> organs;           ///< of this run: one, or none yet
  std::array<std::string, 4> devices;  ///< by tool id; empty: the server did not say it
};

struct Listing {
  std::uint32_t domain{0};
  std::vector<Server> servers;        ///< that run, in the order in which they were heard
  std::vector<Publisher> publishers;  ///< by tool id
};

/// Whether a server takes the poses of a publisher.
[[nodiscard]] bool isFor(const Publisher& publisher, const Server& server);

/// Hears what is on a domain: statuses, organs, poses. Keeps a bounded number of each. Threads: any hears, one asks. Real-time: no.
class Survey {
 public:
  static constexpr std::size_t kMostOrgans = 16, kMostPublishers = 64;

  /// @throw dds::DdsError
  explicit Survey(const dds::Participant& participant);

  /// What was heard so far. Asks each server for its tools' devices, up to `patience_s` each.
  [[nodiscard]] Listing listing(double patience_s) const;
  /// One line when a server is there whose types or QoS do not fit; else empty.
  [[nodiscard]] std::string mismatch() const;

 private:
  struct Heard {
    std::uint32_t tool_id, server_id;
    dds::WriterId writer;
    std::uint64_t poses;
    std::int64_t first_ns, last_ns;
  };
  static bool onSurface(const dds::SurfaceMesh& message, void* context) noexcept;
  static void onPose(const dds::ToolPose& pose, dds::WriterId writer, void* context) noexcept;
  [[nodiscard]] std::vector<Publisher> publishers() const;

  const dds::Participant& participant_;
  dds::ProcessBook processes_;
  client::StatusBoard statuses_;
  mutable std::mutex mutex_;  // the next two
  std::vector<Organ> organs_;
  std::vector<Heard> heard_;
  dds::Tap<dds::ToolPose> poses_;  // last, like the next: their callbacks use the rest
  dds::Reader<dds::SurfaceMesh> surfaces_;
};

}  // namespace palpate::list
