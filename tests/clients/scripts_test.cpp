// SPDX-License-Identifier: Apache-2.0
#include "palpate/client/scripts.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "palpate/client/error.h"

namespace palpate::client {
namespace {

const Spot kSpot{3, 4, {0.1, 0.2, 0.3}, {0.6, 0.0, 0.8}};

double heightAt(const device::Path& path, double t, const ScriptOptions& options) {
  return dot(path.at(t) - kSpot.position, kSpot.normal) - options.tip_radius;
}

struct Extent {
  double lowest{1.0};
  double widest{0.0};  // across the normal
  int dives{0};        // how often the tip passes half the depth on its way in
};

Extent extentOf(const device::Path& path, const ScriptOptions& options) {
  Extent extent;
  double before = 1.0;
  for (double t = 0.0; t <= path.seconds(); t += 1e-3) {
    const double height = heightAt(path, t, options);
    const device::Point off = path.at(t) - kSpot.position;
    extent.lowest = std::min(extent.lowest, height);
    extent.widest = std::max(extent.widest, length(off - dot(off, kSpot.normal) * kSpot.normal));
    if (before > -options.depth / 2 && height <= -options.depth / 2) ++extent.dives;
    before = height;
  }
  return extent;
}

std::string refusal(const std::string& script, const ScriptOptions& options) {
  try {
    (void)scriptedPath(script, kSpot, options);
  } catch (const ClientError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(Script, PressGoesToTheDepthAlongTheNormalAndComesBack) {
  const ScriptOptions options{.tip_radius = 0.004, .depth = 0.002};
  const device::Path path = scriptedPath("press", kSpot, options);
  const Extent extent = extentOf(path, options);
  EXPECT_NEAR(extent.lowest, -0.002, 1e-9);
  EXPECT_NEAR(extent.widest, 0.0, 1e-12);
  EXPECT_EQ(extent.dives, 1);
  EXPECT_NEAR(heightAt(path, 0.0, options), options.clearance, 1e-12);
  EXPECT_NEAR(heightAt(path, path.seconds(), options), options.clearance, 1e-12);
}

TEST(Script, SlideMovesAlongTheSurface) {
  const ScriptOptions options;
  const Extent extent = extentOf(scriptedPath("slide", kSpot, options), options);
  EXPECT_NEAR(extent.lowest, -options.depth, 1e-9);
  EXPECT_NEAR(extent.widest, options.slide_distance, 1e-9);
}

TEST(Script, PokeGoesInAsOftenAsAsked) {
  ScriptOptions options;
  options.pokes = 5;
  EXPECT_EQ(extentOf(scriptedPath("poke", kSpot, options), options).dives, 5);
}

TEST(Script, RejectsWhatIsOutOfRange) {
  ScriptOptions deep;
  deep.depth = 0.2;
  EXPECT_EQ(refusal("press", deep), "depth (m) is 0.2, expected above 0 and at most 0.05");
  ScriptOptions nan;
  nan.slide_distance = std::nan("");
  EXPECT_EQ(refusal("slide", nan), "slide distance (m) is nan, expected above 0 and at most 0.1");
  ScriptOptions radius;
  radius.tip_radius = -1.0;
  EXPECT_EQ(refusal("press", radius), "tip radius is -1.000000 m, expected 0 to 0.05");
  EXPECT_EQ(refusal("dance", {}), "unknown script 'dance', expected press, slide or poke");
}

}  // namespace
}  // namespace palpate::client
