// SPDX-License-Identifier: Apache-2.0
#include "palpate/testing/test_domain.h"

#include <fcntl.h>
#include <netinet/in.h>
#include <sys/file.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cstdlib>
#include <random>
#include <stdexcept>
#include <string>

namespace palpate::testing {
namespace {

// Whether a participant is in the domain on this machine: it listens on UDP port 7400 + 250 * domain + 10.
bool inUse(std::uint32_t domain) {
  const int fd = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<std::uint16_t>(7410 + 250 * domain));
  address.sin_addr.s_addr = htonl(INADDR_ANY);
  const bool taken =
      bind(fd, static_cast<const sockaddr*>(static_cast<const void*>(&address)), sizeof address) != 0;
  close(fd);
  return taken;
}

}  // namespace

void useLoopback() {
  setenv("CYCLONEDDS_URI",
         "<CycloneDDS><Domain><General><Interfaces><NetworkInterface name=\"lo\" "
         "multicast=\"false\"/></Interfaces>"
         "<AllowMulticast>false</AllowMulticast></General>"
         "<Discovery><ParticipantIndex>auto</ParticipantIndex><MaxAutoParticipantIndex>30</"
         "MaxAutoParticipantIndex>"
         "<Peers><Peer address=\"127.0.0.1\"/></Peers></Discovery></Domain></CycloneDDS>",
         0);
}

std::uint32_t exclusiveDomain() {
  static const std::uint32_t domain = [] {
    useLoopback();
    std::random_device random;
    for (int attempt = 0; attempt < 400; ++attempt) {
      const std::uint32_t candidate = 1 + random() % 100;
      const std::string path = "/tmp/palpate-test-domain-" + std::to_string(candidate);
      const int fd = open(path.c_str(), O_CREAT | O_RDWR | O_CLOEXEC, 0666);
      if (fd < 0) continue;
      if (flock(fd, LOCK_EX | LOCK_NB) == 0 && !inUse(candidate))
        return candidate;  // the descriptor stays open on purpose: it is the lock
      close(fd);
    }
    throw std::runtime_error("no free DDS domain among 1 to 100: do many tests run at once?");
  }();
  return domain;
}

}  // namespace palpate::testing
