// SPDX-License-Identifier: Apache-2.0
#include "palpate/server/receive_watch.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <optional>
#include <string>

#include "palpate/rt/clock.h"
#include "palpate/testing/files.h"

namespace palpate::server {
namespace {

using rt::kMs;
constexpr int kDomain = 3;  // ports 8150 (0x1FD6) to 8399

// A process with the sockets 100 and 101 and one receive thread, as /proc shows it.
class ReceiveWatchTest : public ::testing::Test {
 protected:
  ReceiveWatchTest() {
    for (const char* const folder : {"fd", "net", "task/7", "task/8"})
      std::filesystem::create_directories(folder_ / folder);
    std::filesystem::create_symlink("socket:[100]", folder_ / "fd/5");
    std::filesystem::create_symlink("socket:[101]", folder_ / "fd/6");
    (void)folder_.write("task/7/comm", "tick\n");
    (void)folder_.write("task/7/schedstat", "1 2 3\n");
    (void)folder_.write("task/8/comm", "recvUC\n");
    ran(0);
    wait("1FE0", 0, 100);
    watch_.emplace(kDomain, folder_.path());
  }

  void ran(std::int64_t ns) const { (void)folder_.write("task/8/schedstat", std::to_string(ns) + " 17 4\n"); }
  // @param[in] port, bytes  hexadecimal
  void wait(const std::string& port, int bytes, int inode, const std::string& file = "udp") const {
    (void)folder_.write("net/" + file,
                        "  sl  local_address rem_address   st tx_queue rx_queue tr tm->when retrnsmt   uid  "
                        "timeout inode ref pointer drops\n"
                        " 1234: 00000000:" +
                            port + " 00000000:0000 07 00000000:" + std::to_string(bytes) +
                            " 00:00000000 00000000     0        0 " + std::to_string(inode) +
                            " 2 0000000000000000 0\n");
  }
  // A look 100 ms after the one before.
  bool look() { return watch_->takes(now_ns_ += 100 * kMs); }

  palpate::testing::TemporaryFolder folder_;
  std::int64_t now_ns_{0};
  std::optional<ReceiveWatch> watch_;
};

TEST_F(ReceiveWatchTest, NothingThatComesIsNoFault) {
  EXPECT_TRUE(look());
  EXPECT_TRUE(look());
}

TEST_F(ReceiveWatchTest, WhatWaitsWhileTheThreadDoesNotRunIsNotTaken) {
  EXPECT_TRUE(look());
  wait("1FE0", 1200, 100);
  EXPECT_TRUE(look()) << "it may have come just now";
  EXPECT_FALSE(look());
  wait("1FE0", 2400, 100);
  EXPECT_FALSE(look());
  wait("1FE0", 1200, 100);
  EXPECT_TRUE(look()) << "some was taken";
}

TEST_F(ReceiveWatchTest, SocketsOfTheSixthVersionCount) {
  wait("1FE0", 1200, 101, "udp6");
  EXPECT_TRUE(look());
  EXPECT_FALSE(look());
}

TEST_F(ReceiveWatchTest, AFloodThatKeepsTheThreadBusyIsNoFault) {
  wait("1FE0", 9000, 100);
  EXPECT_TRUE(look());
  ran(60 * kMs);
  EXPECT_TRUE(look());
  ran(61 * kMs);
  EXPECT_FALSE(look()) << "no longer busy";
}

TEST_F(ReceiveWatchTest, AFloodOfDiscoveryAndAThreadThatWaitsForAProcessorAreNoFault) {
  std::filesystem::create_directories(folder_ / "task/9");
  (void)folder_.write("task/9/comm", "dq.builtins\n");
  (void)folder_.write("task/9/schedstat", "0 0 0\n");
  wait("1FE0", 9000, 100);
  EXPECT_TRUE(look());
  (void)folder_.write("task/9/schedstat", "60000000 0 9\n");
  EXPECT_TRUE(look()) << "it discovers";
  (void)folder_.write("task/9/schedstat", "60000000 60000000 9\n");
  EXPECT_TRUE(look()) << "it waits for a processor";
  EXPECT_FALSE(look());
}

TEST_F(ReceiveWatchTest, WhatComesToAnotherPortOrAnotherProcessDoesNotCount) {
  wait("9C40", 1200, 100);  // Cyclone sends from such a port, and reads none of it
  EXPECT_TRUE(look());
  EXPECT_TRUE(look());
  wait("1FE0", 1200, 4711);
  EXPECT_TRUE(look());
  EXPECT_TRUE(look());
}

TEST_F(ReceiveWatchTest, WhatCannotBeReadIsNoFault) {
  wait("1FE0", 9000, 100);
  EXPECT_TRUE(look());
  for (const char* const text : {"x", "5 y 1\n", "99999999999999999999 0 1\n", ""}) {
    (void)folder_.write("task/8/schedstat", text);
    EXPECT_TRUE(look()) << text;
    EXPECT_TRUE(look()) << text;
  }
  ran(0);
  EXPECT_TRUE(look()) << "there is no look before it";
  EXPECT_FALSE(look());
  std::filesystem::remove_all(folder_ / "task");
  EXPECT_TRUE(look());
}

TEST_F(ReceiveWatchTest, NeedsAReceiveThread) {
  (void)folder_.write("task/8/comm", "recvUC-low\n");
  EXPECT_TRUE(look()) << "one that was lowered";
  (void)folder_.write("task/8/comm", "dq.builtins\n");
  EXPECT_FALSE(look());
}

}  // namespace
}  // namespace palpate::server
