// SPDX-License-Identifier: Apache-2.0
// A network between device and server: two network namespaces, and what this process makes of the frames between them.
#include <fcntl.h>
#include <net/if.h>
#include <sched.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <string>

#include "emulated_network.h"
#include "rig.h"

namespace palpate::faults {
namespace {

constexpr double kFound = 1000.0;  // ms: DDS sends again what is new, and two ramps

// The end of the server's namespace.
class Link {
 public:
  explicit Link(const char* name) : socket_(socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0)) {
    std::string(name).copy(request_.ifr_name, IFNAMSIZ - 1);
  }
  ~Link() { close(socket_); }
  Link(const Link&) = delete;
  Link& operator=(const Link&) = delete;

  [[nodiscard]] bool set(bool up) {
    if (ioctl(socket_, SIOCGIFFLAGS, &request_) != 0) return false;
    request_.ifr_flags = static_cast<short>(up ? request_.ifr_flags | IFF_UP : request_.ifr_flags & ~IFF_UP);
    return ioctl(socket_, SIOCSIFFLAGS, &request_) == 0;
  }

 private:
  int socket_;
  ifreq request_{};
};

// The network of the thread that opened it; -1: this kernel has none.
int thisNetwork() {
  return open("/proc/thread-self/ns/net", O_RDONLY | O_CLOEXEC);
}

// What is started from now on talks to the other by this interface alone.
void useInterface(const std::string& name) {
  const std::string uri =
      "<CycloneDDS><Domain><General><Interfaces><NetworkInterface name=\"" + name +
      "\" multicast=\"false\"/></Interfaces><AllowMulticast>false</AllowMulticast></General><Discovery>"
      "<ParticipantIndex>auto</ParticipantIndex><Peers><Peer address=\"10.77.0.1\"/><Peer "
      "address=\"10.77.0.2\"/>"
      "</Peers></Discovery></Domain></CycloneDDS>";
  setenv("CYCLONEDDS_URI", uri.c_str(), 1);
}

class NetworkFault : public Fault {
 protected:
  ~NetworkFault() override {
    device_.reset();
    server_.reset();
    network_.reset();
    (void)setns(home_, CLONE_NEWNET);
    for (const int network : {home_, device_network_, server_network_})
      if (network >= 0) close(network);
    unsetenv("CYCLONEDDS_URI");
    palpate::testing::useLoopback();
  }

  // A namespace for the device, and one for the server and this thread. @return whether they were granted
  bool connect() {
    if (unshare(CLONE_NEWNET) != 0) return false;
    device_network_ = thisNetwork();
    auto device = NetworkEnd::make("device", 2);
    if (!device || unshare(CLONE_NEWNET) != 0) return false;
    server_network_ = thisNetwork();
    auto server = NetworkEnd::make("server", 1);
    if (!server) return false;
    network_ = std::make_unique<EmulatedNetwork>(std::move(device), std::move(server));
    return true;
  }

  void startBoth() {
    ASSERT_EQ(setns(device_network_, CLONE_NEWNET), 0);
    useInterface("device");
    startDevice();
    ASSERT_EQ(setns(server_network_, CLONE_NEWNET), 0);
    useInterface("server");
    ASSERT_NO_FATAL_FAILURE(start());
  }

  std::unique_ptr<EmulatedNetwork> network_;

 private:
  int home_{thisNetwork()};
  int device_network_{-1};
  int server_network_{-1};
};

TEST_F(NetworkFault, ACutNetworkLeavesNoForceAndIsFoundAgain) {
  if (!connect())
    GTEST_SKIP() << "no two network namespaces, or no TAP device (/dev/net/tun), may be made here";
  ASSERT_NO_FATAL_FAILURE(startBoth());
  Link link("server");
  const auto cutFor = [&](milliseconds time) {
    expect(
        "network: cut for " + std::to_string(time.count()) + " ms", Force::kZero,
        [&] {
          ASSERT_TRUE(link.set(false));
          wait(time);
          ASSERT_TRUE(link.set(true));
        },
        kFound);
  };
  cutFor(milliseconds(500));
  cutFor(milliseconds(2000));  // the device looks for another server meanwhile
}

TEST_F(NetworkFault, TheForceGoesOnOverALossyNetworkAndEndsOverASlowOne) {
  if (!connect())
    GTEST_SKIP() << "no two network namespaces, or no TAP device (/dev/net/tun), may be made here";
  ASSERT_NO_FATAL_FAILURE(startBoth());
  const auto forASecond = [&](const std::string& what, double lost, int delay_ms, Force wanted) {
    double stays = 0.0;  // the largest force after the first 0.4 s, N
    also_ = [&] {
      return wanted == Force::kZero && stays > 0.0 ? "a force of " + std::to_string(stays) + " N"
                                                   : std::string();
    };
    expect(
        "network: " + what + " for 1 s, both ways", wanted,
        [&] {
          network_->lose(lost);
          network_->delay(milliseconds(delay_ms));
          wait(milliseconds(400));
          const std::int64_t from_ns = rt::monotonicNow();
          wait(milliseconds(600));
          stays = 0.0;
          for (const Sample& sample : samplesSince(from_ns)) stays = std::max(stays, sample.force);
          network_->lose(0.0);
          network_->delay(milliseconds(0));
        },
        kFound);
  };
  forASecond("a tenth lost", 0.1, 0, Force::kGoesOn);
  forASecond("a fifth lost", 0.2, 0, Force::kGoesOn);
  forASecond("5 ms", 0.0, 5, Force::kGoesOn);
  forASecond("a tenth lost, 15 ms", 0.1, 15, Force::kGoesOn);
  forASecond("100 ms", 0.0, 100, Force::kZero);
  forASecond("all lost", 1.0, 0, Force::kZero);
}

}  // namespace
}  // namespace palpate::faults
