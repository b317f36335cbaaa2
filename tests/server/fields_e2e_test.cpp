// SPDX-License-Identifier: Apache-2.0
// How many surface fields cross the wire: by who reads them, and by what moves.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <vector>

#include "server_fixture.h"

namespace palpate::server::testing {
namespace {

using Clock = std::chrono::steady_clock;

// Reads fields and nothing else.
struct Viewer {
  explicit Viewer(std::uint32_t domain) : participant(domain), fields(participant) {}

  // Counters of the fields that come in so many milliseconds.
  std::vector<std::uint64_t> seqsFor(int milliseconds) {
    std::vector<std::uint64_t> seqs;
    const auto end = Clock::now() + std::chrono::milliseconds(milliseconds);
    while (Clock::now() < end) {
      const auto samples = fields.takeLoaned();
      for (std::size_t i = 0; i < samples.size(); ++i) {
        seqs.push_back(samples[i].seq);
        poses.push_back(samples[i].pose_seq[0]);
        stamped = stamped && samples[i].pose_stamp_ns[0] > 0 && samples[i].pose_stamp_ns[1] == 0;
      }
      pause(1);
    }
    return seqs;
  }

  dds::Participant participant;
  dds::Reader<dds::SurfaceDisplacement> fields;
  std::vector<std::uint64_t> poses;  // that the fields name of tool 0,
  bool stamped{true};                // and whether all have its stamp, and none of tool 1
};

class FieldsEndToEnd : public ServerEndToEnd {
 protected:
  void serve() {
    server_ = std::make_unique<ServerProcess>(std::vector<std::string>{
        "--model", model_.string(), "--domain", std::to_string(domain_), "--device", "custom"});
    ASSERT_TRUE(status_.waitForWriters(1, std::chrono::seconds(20))) << server_->log();
    pause(500);
  }

 private:
  dds::Participant participant_{domain_};
  dds::Reader<dds::ServerStatus> status_{participant_};
};

TEST_F(FieldsEndToEnd, NobodyReadsSoNoneIsSentAndALateReaderGetsOneAtOnce) {
  ASSERT_NO_FATAL_FAILURE(serve());
  Viewer viewer(domain_);
  const auto seqs = viewer.seqsFor(2600);  // one at once, one more, one or two by the second
  ASSERT_FALSE(seqs.empty()) << server_->log();
  EXPECT_LE(seqs.front(), 2U) << "fields were made before anybody read them";
  EXPECT_GE(seqs.size(), 2U);
  EXPECT_LE(seqs.size(), 6U) << "no tool was ever seen";
}

TEST_F(FieldsEndToEnd, APressedOrganSendsOneWithEachTick) {
  ASSERT_NO_FATAL_FAILURE(start());  // its client reads fields
  client_->startSending(atDepth(-0.002));
  pause(20);
  Viewer viewer(domain_);
  std::uint64_t made = 0, shown = 0;
  for (int i = 0; i < 3 && (made <= 100 || shown <= 100); ++i) {  // a machine that stands still makes none
    client_->moveTo(atDepth(-0.002), 50);
    (void)viewer.seqsFor(300);
    viewer.poses.clear();
    std::thread hand([&] { client_->moveTo(atDepth(0.003), 400); });
    const auto seqs = viewer.seqsFor(400);
    hand.join();
    if (seqs.empty()) continue;
    made = seqs.back() - seqs.front();
    shown = viewer.poses.back() - viewer.poses.front();
    EXPECT_TRUE(std::ranges::is_sorted(viewer.poses)) << "each names the pose that it shows";
  }
  EXPECT_GT(made, 100U) << "fields made while the tool went down for 240 ms";
  EXPECT_GT(shown, 100U);
  EXPECT_TRUE(viewer.stamped);
}

}  // namespace
}  // namespace palpate::server::testing
