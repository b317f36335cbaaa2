// SPDX-License-Identifier: Apache-2.0
// A network between device and server: two network namespaces and a pair of Ethernet ends, which are gone with the test's thread.
#include <fcntl.h>
#include <net/if.h>
#include <sched.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cstdlib>
#include <string>

#include "rig.h"

namespace palpate::faults {
namespace {

constexpr double kFound = 1000.0;  // ms: DDS sends again what is new, and two ramps

bool ran(const std::string& command) {
  return std::system(command.c_str()) == 0;
}

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
    (void)setns(home_, CLONE_NEWNET);
    for (const int network : {home_, device_network_, server_network_})
      if (network >= 0) close(network);
    unsetenv("CYCLONEDDS_URI");
    palpate::testing::useLoopback();
  }

  // The device in one namespace, this thread and the server in another. @return whether it was granted
  bool connect() {
    if (unshare(CLONE_NEWNET) != 0) return false;
    device_network_ = thisNetwork();
    if (unshare(CLONE_NEWNET) != 0) return false;
    server_network_ = thisNetwork();
    const std::string device = "/proc/" + std::to_string(getpid()) + "/fd/" + std::to_string(device_network_);
    return ran("ip link add server type veth peer name device && ip addr add 10.77.0.1/24 dev server && "
               "ip link set server up && ip link set device netns " +
               device) &&
           setns(device_network_, CLONE_NEWNET) == 0 &&
           ran("ip addr add 10.77.0.2/24 dev device && ip link set device up");
  }

  // Where connect() left this thread in the device's network.
  void startBoth() {
    useInterface("device");
    startDevice();
    ASSERT_EQ(setns(server_network_, CLONE_NEWNET), 0);
    useInterface("server");
    ASSERT_NO_FATAL_FAILURE(start());
  }

 private:
  int home_{thisNetwork()};
  int device_network_{-1};
  int server_network_{-1};
};

TEST_F(NetworkFault, ACutNetworkLeavesNoForceAndIsFoundAgain) {
  if (!connect()) GTEST_SKIP() << "no two network namespaces may be made and joined here";
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

}  // namespace
}  // namespace palpate::faults
