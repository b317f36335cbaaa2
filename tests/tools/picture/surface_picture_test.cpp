// SPDX-License-Identifier: Apache-2.0
#include "tools/picture/surface_picture.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <map>

#include "palpate/testing/xml_fault.h"
#include "tools/picture/drawn_surface.h"

namespace palpate::picture {

namespace {

/// A tetrahedron whose face 0 1 2 looks along z, and a second one of the same kind, higher.
struct Tetrahedra {
  std::vector<double> positions{0, 0, 0, 1, 0, 0, 0, 1, 0, .2, .2, -1};
  std::vector<std::int32_t> triangles{0, 1, 2, 0, 3, 1, 1, 3, 2, 0, 2, 3};

  void addAbove(double z) {
    for (std::size_t i = 0; i < 12; ++i) positions.push_back(positions[i] + (i % 3 == 2 ? z : 0.0));
    for (std::size_t i = 0; i < 12; ++i) triangles.push_back(triangles[i] + 4);
  }
  /// Borrows this.
  [[nodiscard]] ColouredSurface with(std::vector<std::optional<double>> numbers) const& {
    return {positions, triangles, std::move(numbers)};
  }
};

constexpr Frame kSquare{0, 0, 100, 100};

/// Areas of the paths by colour, px^2, and the colours in the order in which they are drawn.
struct Drawn {
  std::map<std::string, double> area;
  std::vector<std::string> order;
};

Drawn read(const std::string& svg) {
  Drawn drawn;
  for (std::size_t at = svg.find("color=\""); at != std::string::npos; at = svg.find("color=\"", at + 1)) {
    const std::string colour = svg.substr(at + 7, 7);
    std::vector<std::array<double, 2>> corners;
    const char* d = svg.c_str() + svg.find(" d=\"", at) + 4;
    std::array<double, 2> p{};
    int used = 0;
    for (; std::sscanf(d, "%*1[ML]%lf %lf%n", &p[0], &p[1], &used) == 2; d += used) corners.push_back(p);
    double twice = 0.0;
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const auto &a = corners[i], &b = corners[(i + 1) % corners.size()];
      twice += a[0] * b[1] - a[1] * b[0];
    }
    drawn.area[colour] += 0.5 * std::abs(twice);
    drawn.order.push_back(colour);
  }
  return drawn;
}

Drawn draw(const ColouredSurface& surface) {
  return read(drawnSurface(surface, Camera(surface, kSquare), ColourSteps(surface.numbers)));
}

}  // namespace

TEST(SurfacePicture, StepsOfColourEndWhereTheNumbersDo) {
  const Tetrahedra one;
  const ColouredSurface shown = one.with({10.0, 0.0, 0.0, 0.0});
  const ColourSteps steps(shown.numbers);
  ASSERT_EQ(steps.count(), 10U);
  Drawn drawn = draw(shown);
  ASSERT_EQ(drawn.area.size(), 10U) << "faces that look away are not drawn";
  for (std::size_t i = 0; i < 10; ++i) {
    const double below = 1.0 - 0.1 * double(i), above = 0.9 - 0.1 * double(i);
    EXPECT_NEAR(drawn.area[steps.colour(i, 1.0)], 5000.0 * (below * below - above * above), 10.0) << i;
  }
}

TEST(SurfacePicture, DarkerIsMore) {
  const ColourSteps steps(std::vector<std::optional<double>>{-3.0, 20.0, std::nullopt});
  EXPECT_LE(steps.end(0), -3.0);
  EXPECT_GE(steps.end(steps.count()), 20.0);
  const auto brightness = [&](std::size_t i) {
    unsigned r = 0, g = 0, b = 0;
    EXPECT_EQ(std::sscanf(steps.colour(i, 1.0).c_str(), "#%2x%2x%2x", &r, &g, &b), 3);
    return 0.2126 * r + 0.7152 * g + 0.0722 * b;
  };
  for (std::size_t i = 1; i < steps.count(); ++i) EXPECT_LT(brightness(i), brightness(i - 1)) << i;
}

TEST(SurfacePicture, NearTrianglesAreDrawnOverFarOnes) {
  for (const double z : {5.0, -5.0}) {
    Tetrahedra two;
    two.addAbove(z);
    const ColouredSurface shown = two.with({0.0, 0.0, 0.0, 0.0, 1.0, 1.0, 1.0, 1.0});
    const ColourSteps steps(shown.numbers);
    const std::string first = steps.colour(0, 1.0), second = steps.colour(steps.count() - 1, 1.0);
    EXPECT_EQ(draw(shown).order, (z > 0.0 ? std::vector{first, second} : std::vector{second, first}));
  }
}

TEST(SurfacePicture, NodesWithoutANumberMakeTheirTrianglesGrey) {
  const Tetrahedra one;
  const Drawn drawn = draw(one.with({std::nullopt, 0.0, 1.0, 1.0}));
  ASSERT_EQ(drawn.order.size(), 1U);
  EXPECT_EQ(drawn.order[0].substr(1, 2), drawn.order[0].substr(3, 2));
  EXPECT_EQ(drawn.order[0].substr(1, 2), drawn.order[0].substr(5, 2));
}

TEST(SurfacePicture, CameraLooksFromOutsideWithZUp) {
  const Tetrahedra one;
  ColouredSurface shown = one.with({0.0, 0.0, 0.0, 0.0});
  shown.towards_eye = Vec3(0.0, -1.0, 0.0);
  const Camera camera(shown, kSquare);
  const Vec3 origin = camera.place(Vec3::Zero());
  EXPECT_GT(camera.place(Vec3::UnitX()).x(), origin.x()) << "x to the right for who looks along y";
  EXPECT_LT(camera.place(Vec3::UnitZ()).y(), origin.y()) << "z up";
  EXPECT_GT(camera.place(-Vec3::UnitY()).z(), origin.z()) << "nearer";
  EXPECT_NEAR(camera.scale(), 100.0, 1e-9);
}

TEST(SurfacePicture, OutlineOfAnOctahedronIsASquare) {
  const RegionSurface surface{8,
                              Vec3::Zero(),
                              {1, 0, 0, -1, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 1, 0, 0, -1},
                              {0, 2, 4, 2, 1, 4, 1, 3, 4, 3, 0, 4, 2, 0, 5, 1, 2, 5, 3, 1, 5, 0, 3, 5}};
  const Tetrahedra one;
  const ColouredSurface shown = one.with({0.0, 0.0, 0.0, 0.0});
  const std::string d = outlineOf(surface, Camera(shown, kSquare));
  EXPECT_EQ(std::count(d.begin(), d.end(), 'M'), 1) << d;
  EXPECT_EQ(std::count(d.begin(), d.end(), 'L'), 3) << d;
  EXPECT_EQ(d.back(), 'Z');
}

TEST(SurfacePicture, MarksBehindTheSurfaceAreHidden) {
  Tetrahedra two;
  two.addAbove(5.0);
  const ColouredSurface shown = two.with(std::vector<std::optional<double>>(8));
  const Camera camera(shown, kSquare);
  EXPECT_FALSE(isHidden(shown, camera, Vec3(0.2, 0.2, 5.0)));
  EXPECT_TRUE(isHidden(shown, camera, Vec3(0.2, 0.2, 0.0))) << "the other one is in front";
  EXPECT_TRUE(isHidden(shown, camera, Vec3(0.2, 0.2, 4.0))) << "on its back";
  EXPECT_FALSE(isHidden(shown, camera, Vec3(0.9, 0.9, 0.0))) << "beside it";
  SurfacePicture picture;
  picture.surface = shown;
  picture.marks = {{Vec3(0.2, 0.2, 5.0), 1.0}, {Vec3(0.3, 0.3, 0.0), 2.0}, {Vec3(0.1, 0.4, 5.0), 3.0, true}};
  const std::string svg = picture.svg();
  EXPECT_EQ(testing::xmlFault(svg), "");
  const auto count = [&](const char* part) {
    std::size_t found = 0;
    for (std::size_t at = svg.find(part); at != std::string::npos; at = svg.find(part, at + 1)) ++found;
    return found;
  };
  EXPECT_EQ(count("<circle class=\"mark\""), 1U);
  EXPECT_EQ(count("<rect class=\"mark\""), 1U);
  EXPECT_NE(svg.find(">3<"), std::string::npos) << "the bar covers marks";
}

TEST(SurfacePicture, ANumberLiesInItsStep) {
  const ColourSteps steps(std::vector<std::optional<double>>{0.0, 10.0});
  ASSERT_EQ(steps.count(), 10U);
  EXPECT_EQ(steps.stepOf(-1.0), 0U);
  EXPECT_EQ(steps.stepOf(3.5), 3U);
  EXPECT_EQ(steps.stepOf(10.0), 9U);
  EXPECT_EQ(steps.stepOf(99.0), 9U);
}

TEST(SurfacePicture, TextsAreEscapedAndLengthsAreRound) {
  Tetrahedra small;
  for (double& x : small.positions) x *= 0.1;
  SurfacePicture picture;
  picture.title = "a < b";
  picture.surface = small.with({3.0, 1.0, 0.0, 0.0});
  const std::string svg = picture.svg();
  EXPECT_EQ(testing::xmlFault(svg), "");
  EXPECT_NE(svg.find(">a &lt; b<"), std::string::npos);
  EXPECT_NE(svg.find(">50 mm<"), std::string::npos);
}

}  // namespace palpate::picture
