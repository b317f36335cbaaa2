// SPDX-License-Identifier: Apache-2.0
#include "emulated_network.h"

#include <fcntl.h>
#include <linux/if_tun.h>
#include <net/if.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <deque>
#include <random>
#include <string>
#include <vector>

#include "palpate/rt/scheduling.h"

namespace palpate::faults {
namespace {

using Clock = std::chrono::steady_clock;

constexpr int kPriority = 70;  // as a switch's, above those who send
constexpr std::chrono::milliseconds kLook{20};

struct Frame {
  Clock::time_point due;
  std::vector<char> bytes;
};

}  // namespace

std::unique_ptr<NetworkEnd> NetworkEnd::make(const char* name, int host) {
  const int descriptor = open("/dev/net/tun", O_RDWR | O_NONBLOCK | O_CLOEXEC);
  if (descriptor < 0) return nullptr;
  std::unique_ptr<NetworkEnd> end(new NetworkEnd(descriptor));
  ifreq request{};
  std::string(name).copy(request.ifr_name, IFNAMSIZ - 1);
  request.ifr_flags = IFF_TAP | IFF_NO_PI;
  if (ioctl(descriptor, TUNSETIFF, &request) != 0) return nullptr;
  const std::string dev = std::string(" dev ") + name;
  const std::string command =
      "ip addr add 10.77.0." + std::to_string(host) + "/24" + dev + " && ip link set" + dev + " up";
  return std::system(command.c_str()) == 0 ? std::move(end) : nullptr;
}

NetworkEnd::~NetworkEnd() {
  close(descriptor_);
}

EmulatedNetwork::EmulatedNetwork(std::unique_ptr<NetworkEnd> one, std::unique_ptr<NetworkEnd> other)
    : ends_{std::move(one), std::move(other)}, thread_([this] { run(); }) {}

EmulatedNetwork::~EmulatedNetwork() {
  stopping_ = true;
  thread_.join();
}

void EmulatedNetwork::run() {
  (void)rt::raiseThisThread(kPriority);
  std::mt19937 random(1);
  std::uniform_real_distribution<double> share(0.0, 1.0);
  std::array<std::deque<Frame>, 2> waiting;  // to each end
  std::array<char, 65536> room;
  while (!stopping_) {
    const Clock::time_point now = Clock::now();
    Clock::time_point next = now + kLook;
    for (std::size_t to = 0; to < 2; ++to) {
      for (; !waiting[to].empty() && waiting[to].front().due <= now; waiting[to].pop_front()) {
        const std::vector<char>& bytes = waiting[to].front().bytes;
        (void)!write(ends_[to]->descriptor(), bytes.data(), bytes.size());  // an end that is down takes none
      }
      if (!waiting[to].empty()) next = std::min(next, waiting[to].front().due);
    }
    pollfd wait[2] = {{ends_[0]->descriptor(), POLLIN, 0}, {ends_[1]->descriptor(), POLLIN, 0}};
    const auto left = std::max(next - Clock::now(), Clock::duration::zero());
    const timespec longest{0, std::chrono::nanoseconds(left).count()};
    (void)ppoll(wait, 2, &longest, nullptr);
    for (std::size_t from = 0; from < 2; ++from)
      for (ssize_t size; (size = read(ends_[from]->descriptor(), room.data(), room.size())) > 0;)
        if (share(random) >= lost_)
          waiting[1 - from].push_back({Clock::now() + delay_.load(), {room.data(), room.data() + size}});
  }
}

}  // namespace palpate::faults
