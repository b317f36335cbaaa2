// SPDX-License-Identifier: Apache-2.0
// Pages' requests to a server that the test plays.
#include "parameter_desk.h"

#include <gtest/gtest.h>

#include <thread>

#include "palpate/idl/reader.h"
#include "palpate/testing/test_domain.h"

namespace palpate::viewer {
namespace {

constexpr std::int64_t kMs = 1'000'000;
constexpr std::int64_t kStart = 1'000'000 * kMs;

TEST(ParameterDesk, LaterValuesGoOverEarlierOnes) {
  SetParameters first{};
  first.request = 1;
  first.friction = 0.2;
  first.youngs_modulus = 2.0;
  SetParameters second{};
  second.request = 2;
  second.friction = 0.4;
  const SetParameters both = merged(first, second);
  EXPECT_EQ(both.request, 2U);
  EXPECT_EQ(both.friction, 0.4);
  EXPECT_EQ(both.youngs_modulus, 2.0);
  const dds::ParameterRequest request = requestOf(both, 160e3);
  EXPECT_EQ(request.fields, dds::parameter::kFriction | dds::parameter::kYoungsModulus);
  EXPECT_EQ(request.youngs_modulus, 320e3);
}

// The desk, and the server's end of its topic.
struct Asked {
  dds::Participant participant{testing::exclusiveDomain()};
  dds::Reader<dds::ParameterRequest> requests{participant};
  ParameterDesk desk{participant};

  Asked() {
    for (int i = 0; i < 1000 && requests.matched() == 0; ++i)
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  // The parameters of a server with this number.
  static dds::ServerParameters server(std::uint32_t id, double model_youngs_modulus) {
    dds::ServerParameters known{};
    known.server_id = id;
    known.session = 100 + id;
    known.model_youngs_modulus = model_youngs_modulus;
    return known;
  }
  // The requests that came, after a tend() at this time.
  std::vector<dds::ParameterRequest> at(std::int64_t now_ns,
                                        const dds::ServerParameters& asked = server(0, 100e3)) {
    desk.tend(asked, now_ns);
    std::array<dds::ParameterRequest, dds::kMaxTake> taken{};
    for (int i = 0; i < 100; ++i) {
      if (const std::size_t count = requests.take(taken); count > 0)
        return {taken.begin(), taken.begin() + static_cast<std::ptrdiff_t>(count)};
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return {};
  }
  void drag(double friction, std::uint64_t number) {
    SetParameters wanted{};
    wanted.request = number;
    wanted.friction = friction;
    desk.set(7, wanted);
  }
};

TEST(ParameterDesk, ASliderThatIsDraggedLeavesNoQueue) {
  Asked asked;
  asked.drag(0.1, 1);
  const auto first = asked.at(kStart);
  ASSERT_EQ(first.size(), 1U);
  for (std::uint64_t i = 2; i <= 50; ++i) asked.drag(0.01 * static_cast<double>(i), i);
  EXPECT_TRUE(asked.at(kStart + 10 * kMs).empty()) << "one at a time";
  EXPECT_EQ(asked.at(kStart + 210 * kMs).front().request_id, first[0].request_id) << "asked again, the same";
  dds::ServerParameters answer = Asked::server(0, 100e3);
  answer.request_id = first[0].request_id;
  answer.accepted = true;
  asked.desk.saw(answer);
  const auto second = asked.at(kStart + 220 * kMs);
  ASSERT_EQ(second.size(), 1U);
  EXPECT_EQ(second[0].friction, 0.5) << "the newest of 49";
  const auto answers = asked.desk.answers();
  ASSERT_EQ(answers.size(), 1U);
  EXPECT_EQ(answers[0].request, 1U);
  EXPECT_TRUE(answers[0].accepted);
}

TEST(ParameterDesk, AServerThatDoesNotAnswerIsSaidSo) {
  Asked asked;
  asked.drag(0.1, 5);
  ASSERT_FALSE(asked.at(kStart).empty());
  asked.desk.tend(Asked::server(0, 100e3), kStart + ParameterDesk::kPatienceNs + kMs);
  const auto answers = asked.desk.answers();
  ASSERT_EQ(answers.size(), 1U);
  EXPECT_FALSE(answers[0].accepted);
  EXPECT_EQ(answers[0].request, 5U);
}

TEST(ParameterDesk, TheFactorIsOfTheModelOfTheServerThatIsAsked) {
  Asked asked;
  SetParameters wanted{};
  wanted.youngs_modulus = 2.0;
  asked.desk.set(7, wanted);
  asked.desk.saw(Asked::server(1, 100e3));
  const auto requests = asked.at(kStart, Asked::server(2, 300e3));
  ASSERT_EQ(requests.size(), 1U);
  EXPECT_EQ(requests[0].server_id, 2U);
  EXPECT_EQ(requests[0].session, 102U);
  EXPECT_EQ(requests[0].youngs_modulus, 600e3);
  dds::ServerParameters answer = Asked::server(1, 100e3);  // another's, with the same number
  answer.request_id = requests[0].request_id;
  asked.desk.saw(answer);
  EXPECT_TRUE(asked.desk.answers().empty());
  answer.server_id = 2;
  asked.desk.saw(answer);
  EXPECT_TRUE(asked.desk.answers().empty()) << "another run of it";
  answer.session = 102;
  asked.desk.saw(answer);
  EXPECT_EQ(asked.desk.answers().size(), 1U);
}

TEST(ParameterDesk, WithoutAServerTheWishIsRefused) {
  Asked asked;
  asked.drag(0.1, 6);
  asked.desk.tend(std::nullopt, kStart);
  const auto answers = asked.desk.answers();
  ASSERT_EQ(answers.size(), 1U);
  EXPECT_FALSE(answers[0].accepted);
}

}  // namespace
}  // namespace palpate::viewer
