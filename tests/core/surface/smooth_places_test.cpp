// SPDX-License-Identifier: Apache-2.0
#include "core/surface/smooth_places.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "core/base/index.h"
#include "palpate/testing/synthetic_model.h"

namespace palpate::testing {

namespace {

SmoothPlaces placesOf(const modelfile::ModelData& data) {
  return {data.surface_positions, data.surface_triangles, data.position_of_node};
}

Vec3 pointOf(const modelfile::ModelData& data, const ContactPoint& s) {
  Vec3 X = Vec3::Zero();
  for (std::size_t k = 0; k < 3; ++k)
    X += s.barycentric[k] * Eigen::Map<const Vec3>(data.surface_positions.data() +
                                                   3 * data.surface_triangles[3 * index(s.triangle) + k]);
  return X;
}

bool complete(const modelfile::ModelData& data, std::int32_t t) {
  for (std::size_t k = 0; k < 3; ++k)
    if (data.position_of_node[index(data.surface_triangles[3 * index(t) + k])] < 0) return false;
  return true;
}

}  // namespace

TEST(SmoothPlaces, OfAClosedSurfaceAreItsNodesAndItsEdges) {
  const modelfile::ModelData data = syntheticModel({.subdivisions = 2, .fixed_below = -2.0});
  const SmoothPlaces places = placesOf(data);
  const std::size_t nodes = data.contact_node.size(), edges = data.surface_triangles.size() / 2;
  ASSERT_EQ(nodes, 162U);
  ASSERT_EQ(places.size(), nodes + edges);
  for (std::size_t place = 0; place < places.size(); ++place) {
    const std::size_t triangles = places.views(place).size();
    EXPECT_TRUE(place < nodes ? triangles == 5 || triangles == 6 : triangles == 2) << place;
  }
}

TEST(SmoothPlaces, ViewsOfAPlaceAreOnePointAndTheirSharesSumToOne) {
  const modelfile::ModelData data = syntheticModel({.subdivisions = 2});
  const SmoothPlaces places = placesOf(data);
  for (std::size_t place = 0; place < places.size(); ++place) {
    const auto views = places.views(place);
    double sum = 0.0;
    for (const SmoothPlaces::View& view : views) {
      sum += view.share;
      EXPECT_GT(view.share, 0.0);
      EXPECT_LT((pointOf(data, view.s) - pointOf(data, views.front().s)).norm(), 1e-15);
      for (Eigen::Index k = 0; k < 3; ++k)
        for (std::size_t node = 0; node < 3; ++node) {
          ContactPoint corner{view.s.triangle, {}};
          corner.barycentric[node] = 1.0;
          const double grown = view.slopes.row(k).dot(pointOf(data, corner) - pointOf(data, view.s));
          EXPECT_NEAR(grown, corner.barycentric[index(k)] - view.s.barycentric[index(k)], 1e-12);
        }
    }
    EXPECT_NEAR(sum, 1.0, 1e-14) << place;
  }
}

TEST(SmoothPlaces, AreSeenFromCompleteTrianglesOnly) {
  const modelfile::ModelData data = syntheticModel({.subdivisions = 2});
  const SmoothPlaces places = placesOf(data);
  std::set<std::int32_t> of_triangles;
  std::size_t lonely = 0, rim = 0;
  for (std::int32_t t = 0; index(t) < data.surface_triangles.size() / 3; ++t) {
    EXPECT_EQ(places.of(t)[0] >= 0, complete(data, t));
    for (const std::int32_t place : places.of(t))
      if (place >= 0) of_triangles.insert(place);
  }
  for (std::size_t place = 0; place < places.size(); ++place) {
    const auto views = places.views(place);
    ASSERT_FALSE(views.empty());
    const bool seen = of_triangles.contains(static_cast<std::int32_t>(place));
    EXPECT_TRUE(seen || views.size() == 1) << place;
    lonely += seen ? 0 : 1;
    rim += seen && place < data.contact_node.size() && views.size() < 5 ? 1 : 0;
    for (const SmoothPlaces::View& view : views) EXPECT_EQ(complete(data, view.s.triangle), seen) << place;
  }
  EXPECT_EQ(of_triangles.size() + lonely, places.size());
  EXPECT_GT(rim, 5U) << "no position lay beside triangles that are not complete";
}

}  // namespace palpate::testing
