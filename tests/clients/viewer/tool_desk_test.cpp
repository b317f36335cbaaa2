// SPDX-License-Identifier: Apache-2.0
// Grabs and releases, faster than endings() is called.
#include "tool_desk.h"

#include <gtest/gtest.h>

#include <array>
#include <chrono>
#include <thread>

#include "palpate/idl/reader.h"
#include "palpate/testing/test_domain.h"

namespace palpate::viewer {
namespace {

constexpr std::uint64_t kPage = 7;

class ToolDeskOfAPage : public ::testing::Test {
 protected:
  ToolDeskOfAPage() { desk_.setServer({7, 3, 4, 0.0}); }

  // Waits until the page's tool is over.
  [[nodiscard]] bool over() {
    for (int i = 0; i < 2000 && desk_.toolOf(kPage); ++i)
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    return !desk_.toolOf(kPage);
  }

  dds::Participant participant_{testing::exclusiveDomain()};
  ToolDesk desk_{participant_, {3, 2, 1, 0}};
};

TEST_F(ToolDeskOfAPage, AToolLetGoBeforeItsFirstTargetIsReleased) {
  ASSERT_TRUE(desk_.grab(kPage).granted);
  desk_.release(kPage);
  ASSERT_TRUE(over());
  const auto endings = desk_.endings();
  ASSERT_EQ(endings.size(), 1U);
  EXPECT_EQ(endings[0].page_id, kPage);
  EXPECT_EQ(endings[0].message, "released");
}

TEST_F(ToolDeskOfAPage, AToolThatLiftedOffIsReleased) {
  ASSERT_TRUE(desk_.grab(kPage).granted);
  ASSERT_TRUE(desk_.target(kPage, {{0.0, 0.0, 0.1}}));
  std::this_thread::sleep_for(std::chrono::milliseconds(20));
  desk_.release(kPage);
  ASSERT_TRUE(over());
  const auto endings = desk_.endings();
  ASSERT_EQ(endings.size(), 1U);
  EXPECT_EQ(endings[0].message, "released");
}

TEST_F(ToolDeskOfAPage, TheEndOfAnOldToolIsNotToldAfterANewGrant) {
  ASSERT_TRUE(desk_.grab(kPage).granted);
  desk_.release(kPage);
  ASSERT_TRUE(over());
  ASSERT_TRUE(desk_.grab(kPage).granted);
  EXPECT_TRUE(desk_.endings().empty());
  EXPECT_TRUE(desk_.toolOf(kPage));
}

TEST_F(ToolDeskOfAPage, AGrabRightAfterAReleaseGetsAToolThatStays) {
  for (int i = 0; i < 3; ++i) {  // the 1 kHz thread may or may not run in between
    ASSERT_TRUE(desk_.grab(kPage).granted);
    desk_.release(kPage);
    const ToolGrant grant = desk_.grab(kPage);
    ASSERT_TRUE(grant.granted) << grant.message;
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
    EXPECT_EQ(desk_.toolOf(kPage), grant.tool_id);
    EXPECT_TRUE(desk_.endings().empty());
    desk_.drop(kPage);
    std::this_thread::sleep_for(std::chrono::nanoseconds(2 * ToolDesk::kRestNs));
  }
}

TEST_F(ToolDeskOfAPage, PosesGoToTheServerThatIsFollowed) {
  dds::Reader<dds::ToolPose> poses(participant_);
  for (int i = 0; i < 1000 && poses.matched() == 0; ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  ASSERT_TRUE(desk_.grab(kPage).granted);
  std::array<dds::ToolPose, dds::kMaxTake> taken{};
  std::size_t count = 0;
  for (int i = 0; i < 1000 && count == 0; ++i) {
    ASSERT_TRUE(desk_.target(kPage, {{0.0, 0.0, 0.1}}));
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
    count = poses.take(taken);
  }
  ASSERT_GT(count, 0U);
  EXPECT_EQ(taken[0].server_id, 3U);
}

TEST_F(ToolDeskOfAPage, AToolOfOneServerIsNotHandedToTheNext) {
  ASSERT_TRUE(desk_.grab(kPage).granted);
  ASSERT_TRUE(desk_.target(kPage, {{0.0, 0.0, 0.1}}));
  desk_.setServer({7, 3, 4, 0.0});
  EXPECT_TRUE(desk_.toolOf(kPage)) << "the same run";
  desk_.setServer({8, 3, 4, 0.0});
  EXPECT_FALSE(desk_.toolOf(kPage));
  const auto endings = desk_.endings();
  ASSERT_EQ(endings.size(), 1U);
  EXPECT_EQ(endings[0].message, "another server serves now");
}

TEST_F(ToolDeskOfAPage, AToolOfOneOrganDoesNotPressTheNext) {
  ASSERT_TRUE(desk_.grab(kPage).granted);
  ASSERT_TRUE(desk_.target(kPage, {{0.0, 0.0, 0.1}}));
  desk_.endAll("another organ is shown now");
  EXPECT_FALSE(desk_.toolOf(kPage));
  const auto endings = desk_.endings();
  ASSERT_EQ(endings.size(), 1U);
  EXPECT_EQ(endings[0].page_id, kPage);
}

TEST_F(ToolDeskOfAPage, OfAPageThatIsSilentTheToolIsTakenAway) {
  ASSERT_TRUE(desk_.grab(kPage).granted);
  ASSERT_TRUE(desk_.target(kPage, {{0.0, 0.0, 0.1}}));
  ASSERT_TRUE(over());
  const auto endings = desk_.endings();
  ASSERT_EQ(endings.size(), 1U);
  EXPECT_EQ(endings[0].message, "no target came for 250 ms");
}

}  // namespace
}  // namespace palpate::viewer
