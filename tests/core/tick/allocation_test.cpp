// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <array>
#include <cstdlib>
#include <limits>
#include <new>

#include "../driver.h"
#include "core/response/tool_coupling.h"
#include "palpate/testing/allocation_guard.h"

namespace palpate::testing {

TEST(AllocationGuard, CountsWhatIsAllocated) {
  AllocationGuard guard;
  int* volatile number = new int(1);  // volatile: what nobody looks at a compiler may leave out
  EXPECT_GT(guard.count(), 0U);
  delete number;
  const std::size_t thrown = guard.count();
  int* volatile other = new (std::nothrow) int(1);
  EXPECT_GT(guard.count(), thrown);
  delete other;
#if !PALPATE_SANITIZER_HAS_MALLOC
  const std::size_t before = guard.count();
  void* volatile memory = std::malloc(10);
  std::free(memory);
  EXPECT_GE(guard.count(), before + 2);
#endif
}

TEST(Step, NeverAllocates) {
  const MetaModel model = loadSynthetic({.modes = 40});
  Driver driver(model);
  driver.input().tools[2].present = 1;
  driver.input().tools[2].position = {0.053, 0.0, 0.0};
  const double nan = std::numeric_limits<double>::quiet_NaN();
  std::uint32_t seen = 0;
  std::size_t allocations = 0;
  {
    const AllocationGuard guard;
    for (int ms = 0; ms < 500; ++ms) {
      const double z = 0.056 - 0.014 * std::abs(std::sin(0.03 * ms));
      const bool bad = ms > 200 && ms < 240;
      const std::int64_t age = ms > 300 && ms < 380 ? 1'000'000LL * (ms - 300) : 0;
      seen |= driver.at(Vec3(0.0001 * ms, bad ? nan : 0.0, z), age).flags;
      driver.input().tools[2].present = ms > 400 ? 0 : 1;
    }
    driver.input().shutting_down = 1;
    for (int ms = 0; ms < 50; ++ms) seen |= driver.tick().flags;
    allocations = guard.count();
  }
  EXPECT_EQ(allocations, 0U);
  for (const std::uint32_t flag :
       {kInContact, kNonFinitePose, kStalePose, kBeyondDomain, kRamping, kShuttingDown})
    EXPECT_EQ(seen & flag, flag) << "the path of flag " << flag << " was not taken";
}

TEST(Step, NeverAllocatesWithALoadDrivenModel) {
  for (const Parameters parameters : {Parameters::kForce, Parameters::kLevel}) {
    const MetaModel model = loadSynthetic({.parameters = parameters});
    Driver driver(model);
    std::uint32_t seen = 0;
    std::size_t allocations = 0;
    {
      const AllocationGuard guard;
      for (int ms = 0; ms < 200; ++ms)
        seen |= driver.at(Vec3(0.0001 * ms, 0.0, 0.056 - 0.016 * std::abs(std::sin(0.03 * ms)))).flags;
      allocations = guard.count();
    }
    EXPECT_EQ(allocations, 0U);
    for (const std::uint32_t flag : {kInContact, kBeyondDomain})
      EXPECT_EQ(seen & flag, flag) << "the path of flag " << flag << " was not taken";
  }
}

TEST(ToolCoupling, NeverAllocates) {
  const MetaModel model = loadSynthetic();
  Touches touches(model);
  const std::array<ContactPoint, 2> s{model.surface().closestPoint({0.0, 0.0, 0.06}).s,
                                      model.surface().closestPoint({0.02, 0.0, 0.06}).s};
  const std::array<Vec3, 2> d{Vec3(0.0, 0.0, -0.001), Vec3(0.0005, 0.0, -0.001)};
  std::array<Vec3, 2> own = d;
  std::size_t allocations = 0;
  {
    const AllocationGuard guard;
    ownDisplacements(model, s, d, touches, own);
    (void)ownField(model, s[0], d[0], own[0]);
    allocations = guard.count();
  }
  EXPECT_EQ(allocations, 0U);
  EXPECT_NE(own[0], d[0]);
}

}  // namespace palpate::testing
