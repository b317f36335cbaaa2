// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <set>

namespace palpate::server {

/// Whether DDS's receive threads take what comes in. A thread that is stuck cannot say so, and without clients nothing comes; so it
/// is judged by what waits: a socket of ours that holds datagrams and was not emptied of any, while receive threads hardly ran. A
/// flood, which keeps a socket full, keeps its thread busy. Reads /proc. Threads: one. Real-time: no.
class ReceiveWatch {
 public:
  /// Once DDS's sockets are there. @param[in] domain  whose ports count: whatever comes to another socket, nobody reads
  explicit ReceiveWatch(std::uint32_t domain, std::filesystem::path process = "/proc/self");

  /// Looks. @param[in] now_ns  our monotonic clock
  /// @return whether all is taken, as far as can be told since the look before
  [[nodiscard]] bool takes(std::int64_t now_ns);

 private:
  using Queues = std::map<std::uint64_t, std::uint64_t>;  // socket's inode: bytes that wait
  [[nodiscard]] bool isOurs(std::uint32_t port, std::uint64_t inode) const;
  void readQueues(const std::filesystem::path& file, Queues& queues) const;
  // Nothing: they could not be read.
  struct Threads {
    std::int64_t ran_ns{0};  // or waited for a processor, all together
    bool receive{false};     // one is there that receives
  };
  [[nodiscard]] std::optional<Threads> readThreads() const;

  std::filesystem::path process_;
  std::uint32_t first_port_;
  std::set<std::uint64_t> sockets_;  // by inode
  Queues before_;
  std::int64_t ran_before_ns_{0};
  std::int64_t looked_ns_{0};
};

}  // namespace palpate::server
