// SPDX-License-Identifier: Apache-2.0
#include "palpate/server/announcement_book.h"

#include <gtest/gtest.h>

#include <limits>

namespace palpate::server {
namespace {

constexpr dds::WriterId kDriver = 1'000'000;

dds::ToolAnnouncement word(std::uint32_t tool_id, double force_limit) {
  dds::ToolAnnouncement said{};
  said.tool_id = tool_id;
  said.device_force_limit = force_limit;
  return said;
}

TEST(AnnouncementBook, AFloodOfOneWriterReplacesItsOwnWordOnly) {
  AnnouncementBook book;
  EXPECT_TRUE(book.heard(word(0, 2.0), kDriver));
  for (int i = 1; i <= 10'000; ++i) EXPECT_TRUE(book.heard(word(0, 1e-3 * i), 7));
  const auto said = book.said();
  ASSERT_EQ(said.size(), 2U);
  EXPECT_EQ(said[0].writer, kDriver);
  EXPECT_EQ(said[0].what.device_force_limit, 2.0);
}

TEST(AnnouncementBook, AWordThatIsRepeatedIsNotNew) {
  AnnouncementBook book;
  for (const double limit : {1.0, std::numeric_limits<double>::quiet_NaN()}) {
    (void)book.heard(word(0, limit), kDriver);
    const std::uint64_t number = book.said()[0].number;
    (void)book.heard(word(0, limit), kDriver);
    EXPECT_EQ(book.said()[0].number, number);
  }
  (void)book.heard(word(0, 2.0), kDriver);
  EXPECT_EQ(book.said()[0].number, 3U);
}

TEST(AnnouncementBook, WhereThereIsNoPlaceLeftAnOwnerTakesAStrangers) {
  AnnouncementBook book;
  for (dds::WriterId writer = 1; writer <= AnnouncementBook::kMost; ++writer)
    EXPECT_TRUE(book.heard(word(0, 1.0), writer));
  EXPECT_FALSE(book.heard(word(0, 2.0), kDriver));
  book.prefer({kDriver});
  EXPECT_TRUE(book.heard(word(0, 2.0), kDriver));
  EXPECT_EQ(book.said().size(), AnnouncementBook::kMost);
  book.forget(kDriver);
  EXPECT_EQ(book.said().size(), AnnouncementBook::kMost - 1);
}

}  // namespace
}  // namespace palpate::server
