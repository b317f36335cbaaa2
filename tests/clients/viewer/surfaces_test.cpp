// SPDX-License-Identifier: Apache-2.0
#include "surfaces.h"

#include <gtest/gtest.h>

#include "../small_surface.h"
#include "palpate/client/error.h"

namespace palpate::viewer {
namespace {

TEST(Surfaces, ASurfaceTooLargeToShowIsRefusedUnread) {
  testing::SmallSurface small;
  dds::SurfaceMesh positions = small.message();
  positions.positions = {3'000'003, 3'000'003, nullptr, false};
  EXPECT_THROW((void)Surfaces::bounded(positions), client::ClientError);
  dds::SurfaceMesh triangles = small.message();
  triangles.triangles = {3'000'003, 3'000'003, nullptr, false};
  EXPECT_THROW((void)Surfaces::bounded(triangles), client::ClientError);
  EXPECT_EQ(Surfaces::bounded(small.message()).positions.size(), 5U);
  dds::Region region{};
  region.positions = {2'999'988, 2'999'988, nullptr, false};  // 3 too many with the surface's own 15
  small.regions = {region};
  EXPECT_THROW((void)Surfaces::bounded(small.message()), client::ClientError);
  small.regions.assign(257, dds::Region{});
  EXPECT_THROW((void)Surfaces::bounded(small.message()), client::ClientError);
}

}  // namespace
}  // namespace palpate::viewer
