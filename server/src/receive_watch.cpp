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

/// What a folder of /proc holds. @return false: it could not be read to the end
template <class Function>
bool forEachIn(const fs::path& folder, const Function& function) {
  std::error_code gone;
  for (fs::directory_iterator at(folder, gone), end; !gone && at != end; at.increment(gone))
    function(at->path());
  return !gone;
}

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
  (void)forEachIn(process_ / "fd", [&](const fs::path& descriptor) {
    if (const std::uint64_t inode = inodeOf(descriptor); inode != 0) sockets_.insert(inode);
  });
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

std::optional<ReceiveWatch::Threads> ReceiveWatch::readThreads() const {
  Threads threads;
  bool all = true;
  const bool read = forEachIn(process_ / "task", [&](const fs::path& task) {
    std::string name;
    std::int64_t ns = 0, queued_ns = 0;
    if (!std::getline(std::ifstream(task / "comm"), name)) return;  // it ended
    if (!isReceiveThread(name) && !isDiscoveryThread(name)) return;
    threads.receive = threads.receive || isReceiveThread(name);
    all = all && (std::ifstream(task / "schedstat") >> ns >> queued_ns);
    threads.ran_ns += ns + queued_ns;  // who waits for a processor is not stuck
  });
  return read && all ? std::optional(threads) : std::nullopt;
}

bool ReceiveWatch::takes(std::int64_t now_ns) {
  Queues queues;
  readQueues(process_ / "net/udp", queues);
  readQueues(process_ / "net/udp6", queues);
  const std::optional<Threads> threads = readThreads();
  if (!threads) {  // nothing is known of this look, and the next one has none before it
    before_.clear();
    return true;
  }
  bool untouched = false;
  for (const auto& [inode, waiting] : queues) {
    const auto before = before_.find(inode);
    untouched = untouched || (before != before_.end() && waiting >= before->second);
  }
  const std::int64_t ran_ns = threads->ran_ns - ran_before_ns_;  // negative: a thread ended
  const bool idle = ran_ns >= 0 && ran_ns < (now_ns - looked_ns_) / kBusy;
  before_ = std::move(queues);
  ran_before_ns_ = threads->ran_ns;
  looked_ns_ = now_ns;
  return threads->receive && !(untouched && idle);
}

}  // namespace palpate::server
