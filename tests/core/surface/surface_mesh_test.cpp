// SPDX-License-Identifier: Apache-2.0
#include "core/surface/surface_mesh.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "core/surface/contact_surface.h"
#include "palpate/testing/synthetic_model.h"

namespace palpate::testing {

namespace {

/// A surface of its own, without a model behind it.
struct Shape {
  std::vector<double> positions;
  std::vector<std::int32_t> triangles;
  std::vector<std::int32_t> position_of_node;

  [[nodiscard]] ModelView view() {
    position_of_node.assign(positions.size() / 3, -1);
    ModelView v;
    v.surface_positions = positions;
    v.surface_triangles = v.contact_triangles = triangles;
    v.position_of_node = position_of_node;
    return v;
  }
};

/// A box from 0 to (x, y, z), twelve triangles.
Shape box(double x, double y, double z) {
  Shape shape;
  for (int corner = 0; corner < 8; ++corner)
    shape.positions.insert(shape.positions.end(), {(corner & 1) != 0 ? x : 0.0, (corner & 2) != 0 ? y : 0.0,
                                                   (corner & 4) != 0 ? z : 0.0});
  shape.triangles = {0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4,
                     2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6, 1, 3, 5, 3, 7, 5};
  return shape;
}

/// Two long spikes at a sharp angle: a case in which the sign by a face's normal alone is wrong.
Shape wedge() {
  Shape shape;
  shape.positions = {0, 0, 0, 1, 0, 0, 1, 0.02, 0, 0.9, 0.01, 0.3};
  shape.triangles = {0, 2, 1, 0, 1, 3, 1, 2, 3, 2, 0, 3};
  return shape;
}

double bruteDistance(const Shape& shape, const Vec3& p) {
  double best = std::numeric_limits<double>::infinity();
  for (std::size_t t = 0; t < shape.triangles.size() / 3; ++t) {
    std::array<Vec3, 3> c;
    for (std::size_t k = 0; k < 3; ++k)
      c[k] = Eigen::Map<const Vec3>(shape.positions.data() + 3 * shape.triangles[3 * t + k]);
    // Ternary search over the two barycentric directions: slow, but nothing that the code under test does.
    const auto alongEdge = [&](double a) {
      double low = 0.0, high = 1.0 - a;
      const auto distance = [&](double b) {
        return (p - ((1.0 - a - b) * c[0] + a * c[1] + b * c[2])).norm();
      };
      for (int i = 0; i < 60; ++i) {
        const double one = low + (high - low) / 3.0, two = high - (high - low) / 3.0;
        (distance(one) < distance(two) ? high : low) = distance(one) < distance(two) ? two : one;
      }
      return distance(low);
    };
    double low = 0.0, high = 1.0;
    for (int i = 0; i < 60; ++i) {
      const double one = low + (high - low) / 3.0, two = high - (high - low) / 3.0;
      (alongEdge(one) < alongEdge(two) ? high : low) = alongEdge(one) < alongEdge(two) ? two : one;
    }
    best = std::min(best, alongEdge(low));
  }
  return best;
}

/// Inside when the solid angles of all triangles add up to a full turn.
bool bruteInside(const Shape& shape, const Vec3& p) {
  double sum = 0.0;
  for (std::size_t t = 0; t < shape.triangles.size() / 3; ++t) {
    std::array<Vec3, 3> r;
    for (std::size_t k = 0; k < 3; ++k)
      r[k] = Eigen::Map<const Vec3>(shape.positions.data() + 3 * shape.triangles[3 * t + k]) - p;
    const double a = r[0].norm(), b = r[1].norm(), c = r[2].norm();
    sum += 2.0 * std::atan2(r[0].dot(r[1].cross(r[2])),
                            a * b * c + r[0].dot(r[1]) * c + r[1].dot(r[2]) * a + r[2].dot(r[0]) * b);
  }
  return sum > 6.0;
}

#if defined(__SANITIZE_ADDRESS__)
constexpr int kFewer = 10;  // brute force is some 20 times slower there
#else
constexpr int kFewer = 1;
#endif

void expectAgreesWithBruteForce(Shape shape, double margin, int points) {
  const SurfaceMesh mesh(shape.view());
  std::mt19937 engine(3);
  std::uniform_real_distribution<double> place(0.0, 1.0);
  Vec3 low = Vec3::Constant(1e9), high = -low;
  for (std::size_t i = 0; i < shape.positions.size() / 3; ++i) {
    const Vec3 X = Eigen::Map<const Vec3>(shape.positions.data() + 3 * i);
    low = low.cwiseMin(X);
    high = high.cwiseMax(X);
  }
  int inside = 0;
  for (int i = 0; i < std::max(20, points / kFewer); ++i) {
    Vec3 p;
    for (Eigen::Index axis = 0; axis < 3; ++axis)
      p[axis] = low[axis] - margin + (high[axis] - low[axis] + 2.0 * margin) * place(engine);
    const NearestPoint nearest = mesh.closestPoint(p);
    ASSERT_NEAR(std::abs(nearest.signed_distance), bruteDistance(shape, p), 1e-6) << p.transpose();
    ASSERT_LT((mesh.position(nearest.s) - nearest.position).norm(), 1e-12);
    ASSERT_NEAR((p - nearest.position).norm(), std::abs(nearest.signed_distance), 1e-12);
    if (std::abs(nearest.signed_distance) > 1e-9) {
      ASSERT_EQ(nearest.signed_distance < 0.0, bruteInside(shape, p)) << p.transpose();
    }
    inside += nearest.signed_distance < 0.0 ? 1 : 0;
  }
  EXPECT_GT(inside, 0);
}

Shape sphere() {
  const modelfile::ModelData data = syntheticModel({.subdivisions = 2});
  return {data.surface_positions, data.surface_triangles, {}};
}

}  // namespace

TEST(SurfaceMesh, ClosestPointAndSignAgreeWithBruteForceOnABox) {
  expectAgreesWithBruteForce(box(1.0, 0.6, 0.3), 0.3, 300);
}

TEST(SurfaceMesh, ClosestPointAndSignAgreeWithBruteForceOnAThinPlate) {
  expectAgreesWithBruteForce(box(1.0, 1.0, 0.001), 0.002, 300);
}

TEST(SurfaceMesh, ClosestPointAndSignAgreeWithBruteForceOnASharpWedge) {
  expectAgreesWithBruteForce(wedge(), 0.05, 600);
}

TEST(SurfaceMesh, ClosestPointAndSignAgreeWithBruteForceOnASphere) {
  expectAgreesWithBruteForce(sphere(), 0.02, 20);
}

TEST(SurfaceMesh, ClosestPointIsThatOfEveryTriangleTried) {
  Shape shape = sphere();
  const SurfaceMesh mesh(shape.view());
  std::mt19937 engine(5);
  std::uniform_real_distribution<double> place(-0.1, 0.1);
  for (int i = 0; i < 2000; ++i) {
    const Vec3 p(place(engine), place(engine), place(engine));
    double best = std::numeric_limits<double>::infinity();
    for (std::size_t t = 0; t < shape.triangles.size() / 3; ++t) {
      std::array<Vec3, 3> c;
      for (std::size_t k = 0; k < 3; ++k)
        c[k] = Eigen::Map<const Vec3>(shape.positions.data() + 3 * shape.triangles[3 * t + k]);
      best = std::min(best, closestOnTriangle(p, c[0], c[1], c[2]).squared_distance);
    }
    ASSERT_EQ(std::abs(mesh.closestPoint(p).signed_distance), std::sqrt(best));
  }
}

TEST(SurfaceMesh, SignIsRightRightAboveNodesAndEdges) {
  Shape shape = box(1.0, 1.0, 0.01);
  const SurfaceMesh mesh(shape.view());
  for (const double out : {1e-6, 1e-3, 0.5}) {
    EXPECT_NEAR(mesh.closestPoint(Vec3(1.0 + out, 1.0 + out, 0.01 + out)).signed_distance,
                std::sqrt(3.0) * out, 1e-12);
    EXPECT_NEAR(mesh.closestPoint(Vec3(1.0 + out, 0.5, 0.01 + out)).signed_distance, std::sqrt(2.0) * out,
                1e-12);
  }
  EXPECT_LT(mesh.closestPoint(Vec3(1.0 - 1e-6, 1.0 - 1e-6, 0.005)).signed_distance, 0.0);
}

TEST(SurfaceMesh, NormalIsUnitOutwardAndContinuousAcrossEdges) {
  Shape shape = sphere();
  const SurfaceMesh mesh(shape.view());
  Vec3 last = Vec3::Zero();
  for (int i = 0; i <= 2000; ++i) {
    const double t = i / 2000.0;
    const Vec3 c = 0.05 * Vec3(std::cos(t), std::sin(t), 0.2);
    const Vec3 n = mesh.normal(mesh.closestPoint(c).s);
    EXPECT_NEAR(n.norm(), 1.0, 1e-12);
    EXPECT_GT(n.dot(c.normalized()), 0.99);
    if (i > 0) {
      ASSERT_LT((n - last).norm(), 0.002) << "the walk's own step is 0.0005";
    }
    last = n;
  }
}

TEST(SurfaceMesh, NodeHasAContactPointOnItself) {
  Shape shape = sphere();
  const SurfaceMesh mesh(shape.view());
  for (int node = 0; node < mesh.nodes(); ++node) {
    const Vec3 X = Eigen::Map<const Vec3>(shape.positions.data() + 3 * node);
    ASSERT_EQ(mesh.position(mesh.atNode(node)), X);
    ASSERT_GT(mesh.nodeNormal(node).dot(X.normalized()), 0.99);
  }
}

TEST(SurfaceMesh, NodesWithoutAnAnswerAreDroppedAndWeightsRenormalized) {
  Shape shape = box(1.0, 1.0, 1.0);
  ModelView view = shape.view();
  const std::vector<std::uint8_t> accessible{1, 0};
  view.contact_accessible = accessible;
  shape.position_of_node = {-1, 0, 1, -1, -1, -1, -1, -1};
  view.position_of_node = shape.position_of_node;
  const SurfaceMesh mesh(view);
  const PositionMix mix = mesh.mix({0, {0.5, 0.125, 0.375}});  // triangle 0 is 0, 2, 1
  ASSERT_EQ(mix.count, 2);
  EXPECT_EQ(mix.position[0], 1);
  EXPECT_DOUBLE_EQ(mix.weight[0], 0.25);
  EXPECT_EQ(mix.position[1], 0);
  EXPECT_DOUBLE_EQ(mix.weight[1], 0.75);
  EXPECT_EQ(mesh.mix({0, {1.0, 0.0, 0.0}}).count, 0) << "on a node without an answer";
  EXPECT_EQ(mesh.mix({2, {0.2, 0.3, 0.5}}).count, 0) << "no node has one";
  EXPECT_TRUE(mesh.accessible(0));
  EXPECT_FALSE(mesh.accessible(2));
  EXPECT_FALSE(mesh.accessible(9)) << "2, 4, 6: a helper alone";
}

TEST(ContactSurface, OfSharpAndThinShapesHasTrianglesWithAnArea) {
  for (Shape shape : {box(1.0, 0.6, 0.3), box(1.0, 1.0, 0.001), box(1.0, 1e-4, 1e-4), wedge()}) {
    const ModelView view = shape.view();
    const SurfaceMesh rest(view);
    const ContactSurface surface(view, rest, kMostRoundedTriangles);
    EXPECT_EQ(surface.mesh().triangles(), rest.triangles() << (2 * surface.levels()));
    for (int t = 0; t < rest.triangles(); ++t) {
      const ContactPoint corner{t, {1.0, 0.0, 0.0}};
      EXPECT_LT((surface.mesh().position(surface.fine(corner)) - rest.position(corner)).norm(), 1e-12);
    }
  }
}

}  // namespace palpate::testing
