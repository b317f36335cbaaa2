// SPDX-License-Identifier: Apache-2.0
#include "palpate/server/receive_watch.h"

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <string>
#include <string_view>
#include <utility>

#include "palpate/idl/receive_threads.h"

namespace palpate::server {
namespace {

namespace fs = std::filesystem;

// Of the domain, by the RTPS specification's numbers, which Cyclone keeps (DDSI-RTPS 2.3, 9.6.1.1).
constexpr std::uint32_t kFirstPort = 7400;
constexpr std::uint32_t kPortsPerDomain = 250;
// Share of the time that a busy receive thread runs at least, 1 / kBusy.
constexpr std::int64_t kBusy = 10;

// "socket:[123]"
std::uint64_t inodeOf(const fs::path& descriptor) {
  std::error_code gone;
  const std::string target = fs::read_symlink(descriptor, gone);
  constexpr std::string_view kSocket = "socket:[";
  return target.rfind(kSocket, 0) == 0 ? std::strtoull(target.c_str() + kSocket.size(), nullptr, 10) : 0;
}

// A receive thread waits for dq.builtins, an ordinary thread, where much is discovered.
bool isDiscoveryThread(std::string_view name) {
  return name.rfind("dq.", 0) == 0;
}

// recvUC-low is one that was lowered.
bool isReceiveThread(std::string_view name) {
  for (const std::string_view known : dds::kReceiveThreads)
    if (name == known || name == std::string(known) + "-low") return true;
  return false;
}

}  // namespace

ReceiveWatch::ReceiveWatch(std::uint32_t domain, fs::path process)
    : process_(std::move(process)), first_port_(kFirstPort + kPortsPerDomain * domain) {
  std::error_code gone;
  for (const auto& descriptor : fs::directory_iterator(process_ / "fd", gone))
    if (const std::uint64_t inode = inodeOf(descriptor.path()); inode != 0) sockets_.insert(inode);
}

bool ReceiveWatch::isOurs(std::uint32_t port, std::uint64_t inode) const {
  return port >= first_port_ && port < first_port_ + kPortsPerDomain && sockets_.count(inode) > 0;
}

// "sl local_address rem_address st tx_queue:rx_queue tr:when retrnsmt uid timeout inode ...", addresses and queues in hexadecimal
void ReceiveWatch::readQueues(const fs::path& file, Queues& queues) const {
  std::ifstream lines(file);
  for (std::string line; std::getline(lines, line);) {
    unsigned port = 0;
    unsigned long long waiting = 0, inode = 0;
    if (std::sscanf(line.c_str(), "%*s %*[0-9A-Fa-f]:%x %*s %*s %*[0-9A-Fa-f]:%llx %*s %*s %*s %*s %llu",
                    &port, &waiting, &inode) == 3 &&
        isOurs(port, inode) && waiting > 0)
      queues.emplace(inode, waiting);
  }
}

std::optional<std::int64_t> ReceiveWatch::receiveThreadsRan() const {
  std::int64_t ran_ns = 0;
  bool receives = false;
  std::error_code gone;
  for (const auto& task : fs::directory_iterator(process_ / "task", gone)) {
    std::string name;
    std::int64_t ns = 0, queued_ns = 0;
    if (!std::getline(std::ifstream(task.path() / "comm"), name)) continue;
    if (!isReceiveThread(name) && !isDiscoveryThread(name)) continue;
    receives = receives || isReceiveThread(name);
    std::ifstream(task.path() / "schedstat") >> ns >> queued_ns;
    ran_ns += ns + queued_ns;  // who waits for a processor is not stuck
  }
  return receives ? std::optional(ran_ns) : std::nullopt;
}

bool ReceiveWatch::takes(std::int64_t now_ns) {
  Queues queues;
  readQueues(process_ / "net/udp", queues);
  readQueues(process_ / "net/udp6", queues);
  const std::optional<std::int64_t> ran_ns = receiveThreadsRan();
  bool untouched = false;
  for (const auto& [inode, waiting] : queues) {
    const auto before = before_.find(inode);
    untouched = untouched || (before != before_.end() && waiting >= before->second);
  }
  const bool idle = ran_ns.value_or(0) - ran_before_ns_ < (now_ns - looked_ns_) / kBusy;
  before_ = std::move(queues);
  ran_before_ns_ = ran_ns.value_or(0);
  looked_ns_ = now_ns;
  return ran_ns && !(untouched && idle);
}

}  // namespace palpate::server
