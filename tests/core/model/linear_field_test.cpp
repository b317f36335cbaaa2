// SPDX-License-Identifier: Apache-2.0
// What nodal Green's functions give: of a patch to another, and where the tool itself is.
#include "core/model/linear_field.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "../response/random_touch.h"
#include "core/base/index.h"
#include "core/model/field_evaluation.h"
#include "core/response/tool_coupling.h"

namespace palpate::testing {

namespace {

Vec3 interpolated(const std::vector<float>& u, const ContactPoint& s) {
  Vec3 sum = Vec3::Zero();
  for (std::size_t k = 0; k < 3; ++k) {
    const std::int32_t node = touchedOrgan().view().surface_triangles[3 * index(s.triangle) + k];
    sum += s.barycentric[k] * Eigen::Map<const Eigen::Vector3f>(u.data() + 3 * node).cast<double>();
  }
  return sum;
}

Vec3 fieldAtOwnAnchor(const ContactPoint& s, const Vec3& d) {
  FieldScratch scratch(touchedOrgan());
  const FieldSource source{s, d, 1.0};
  Vec3 u;
  fieldAt(touchedOrgan(), std::span(&source, 1), scratch, std::span(&s, 1), std::span(&u, 1));
  return u;
}

Mat3 stiffnessAt(const ContactPoint& s) {
  PatchStiffness::Value value;
  touchedOrgan().stiffness().at(touchedOrgan().surface(), s, value);
  return value.K;
}

/// One face of six nodes, 3 to 5 in the middles of its edges, and Green's functions of some of its nodes: two modes, and a near
/// field at node 0.
struct Face {
  explicit Face(std::vector<std::int32_t> nodes) : green_node(std::move(nodes)) {
    for (std::size_t g = 0; g < green_node.size(); ++g) {
      for (int number = 0; number < 6; ++number)
        Y.push_back(static_cast<std::int16_t>(7 * (int(g) + 2) * (number + 1) - 30));
      for (const float scale : {0.5F, 0.25F, 2.0F}) scales.push_back(scale);
      for (int number = 0; number < 9; ++number)
        near.push_back(static_cast<std::int16_t>(5 * (int(g) + 1) * (number + 2) - 40));
      near_node.push_back(0);
      offset.push_back(static_cast<std::int64_t>(g) + 1);
    }
    view.surface_mesh_tag = tags;
    view.surface_positions = positions;
    view.surface_triangles = drawn;
    view.contact_triangles = corners;
    view.modes_X_scale = mode_scale;
    view.green_node = green_node;
    view.green_Y = std::span<const std::int16_t>(Y);
    view.green_Y_scale = view.green_near_scale = scales;
    view.green_offset = offset;
    view.green_near_node = near_node;
    view.green_near = std::span<const std::int16_t>(near);
  }
  std::vector<std::int32_t> green_node, near_node;
  std::vector<std::int16_t> Y, near;
  std::vector<float> scales;
  std::vector<std::int64_t> offset{0};
  std::array<std::int64_t, 6> tags{1, 2, 3, 4, 5, 6};
  std::array<double, 18> positions{0, 0, 0, 2, 0, 0, 0, 2, 0, 1, 1, 0, 0, 1, 0, 1, 0, 0};
  std::array<std::int32_t, 12> drawn{0, 5, 4, 5, 1, 3, 4, 3, 2, 3, 4, 5};
  std::array<std::int32_t, 3> corners{0, 1, 2};
  std::array<float, 2> mode_scale{1.0F, 1.0F};
  ModelView view;
};

/// Of a load on one node: the modes' amplitudes, and what node 0 moves by near it.
struct Moved {
  std::vector<float> y;
  Vec3 near;
};
Moved movedBy(const LinearField& field, std::int32_t node, const Vec3& f) {
  PatchNodes patch;
  patch.count = 1;
  patch.node = {node};
  patch.weight = {1.0};
  PatchSources sources = field.room(1);
  field.find(patch, sources);
  Moved moved{std::vector<float>(2), field.nearAt(sources, 0) * f};
  field.addAmplitudes(sources, f, moved.y);
  return moved;
}

}  // namespace

TEST(LinearField, ALoadInTheMiddleOfAnEdgeIsHalfOfEachEnds) {
  const Face face({0, 1, 2, 4});
  const LinearField field(face.view);
  EXPECT_TRUE(field.sharesLoads());
  const Vec3 f(0.3, -0.2, 0.5);
  const Moved middle = movedBy(field, 5, f), one = movedBy(field, 0, f), other = movedBy(field, 1, f);
  ASSERT_GT(std::abs(one.y[0] - other.y[0]), 1.0F);
  for (std::size_t k = 0; k < 2; ++k) EXPECT_FLOAT_EQ(middle.y[k], 0.5F * (one.y[k] + other.y[k]));
  EXPECT_LT((middle.near - 0.5 * (one.near + other.near)).norm(), 1e-6 * middle.near.norm());
  // Node 4 has a Green's function of its own.
  const Moved own = movedBy(field, 4, f), first = movedBy(field, 2, f);
  EXPECT_GT(std::abs(own.y[0] - 0.5F * (one.y[0] + first.y[0])), 1.0F);
}

TEST(LinearField, ALoadInTheMiddleOfAnEdgeIsNotCarriedWithoutBothEnds) {
  const Face face({0, 1});
  const LinearField field(face.view);
  EXPECT_TRUE(field.carries(5));
  EXPECT_FALSE(field.carries(3));
  EXPECT_FALSE(field.carries(4));
  const Face alone({0, 3, 4, 5});
  EXPECT_FALSE(LinearField(alone.view).sharesLoads());
}

TEST(ContactDimple, IsTheFieldAtContactPositions) {
  RandomTouch random;
  for (std::size_t m = 0; m < touchedOrgan().view().positions(); m += 3) {
    const ContactPoint s = touchedOrgan().surface().atNode(touchedOrgan().view().contact_node[m]);
    const Vec3 d = random.vector(0.004);
    const Vec3 expected = interpolated(field(s, d), s);
    EXPECT_LT((fieldAtOwnAnchor(s, d) - expected).norm(), 1e-6 * expected.norm()) << m;
    EXPECT_GT(expected.norm(), 1e-5);
  }
}

/// The organ's edges have every degree of its fields. Beyond r_max too.
TEST(ContactDimple, IsTheFieldAtEdgeMidpoints) {
  RandomTouch random;
  const std::size_t M = touchedOrgan().view().positions();
  ASSERT_GT(touchedOrgan().places().size(), 2 * M);
  ASSERT_EQ(touchedOrgan().edgeCoefficients() + kLinearCoefficients,
            index(touchedOrgan().functions().size()));
  double bent = 0.0;
  for (std::size_t place = M; place < touchedOrgan().places().size(); place += 5) {
    const ContactPoint s = touchedOrgan().places().views(place).front().s;
    const Vec3 d = random.vector(0.008);
    const Vec3 expected = interpolated(field(s, d), s);
    EXPECT_LT((fieldAtOwnAnchor(s, d) - expected).norm(), 1e-5 * d.norm()) << place;
    bent =
        std::max(bent, (interpolated(field(s, 0.001 * d), s) - 0.001 * expected).norm() / (0.001 * d.norm()));
  }
  EXPECT_GT(bent, 0.01) << "degrees of two and more take no part";
}

/// As in a page: to the last bit, in any order of touches.
TEST(ContactDimple, IsTheSameWhereItIsMadeWhenTouched) {
  const ContactDimple touched(touchedOrgan().dimpleParts(), DimpleTable::kWhenTouched);
  RandomTouch random;
  std::vector<double> phi(index(touchedOrgan().functions().size()));
  for (int trial = 0; trial < 300; ++trial) {
    const ContactPoint s = random.contactPoint();
    const PositionMix mix = touchedOrgan().surface().mix(s);
    fieldFunctions(touchedOrgan(), random.vector(0.006), 0.005, phi);
    const Vec3 u = touched.at(touchedOrgan().dimpleParts(), s, mix, phi);
    EXPECT_EQ(u, touchedOrgan().dimple().at(touchedOrgan().dimpleParts(), s, mix, phi)) << trial;
    EXPECT_GT(u.norm(), 0.0);
  }
}

TEST(ContactDimple, IsContinuousOverTheEdgesOfItsTriangles) {
  const Vec3 d(0.001, -0.002, 0.003);
  for (int t = 0; t < touchedOrgan().surface().triangles(); t += 3) {
    if (!touchedOrgan().surface().complete(t)) continue;
    for (std::size_t k = 0; k < 3; ++k) {
      ContactPoint before{t, {}}, after{t, {}};
      before.barycentric[k] = 0.5 - 1e-9, after.barycentric[k] = 0.5 + 1e-9;
      before.barycentric[(k + 1) % 3] = 0.2, after.barycentric[(k + 1) % 3] = 0.2;
      before.barycentric[(k + 2) % 3] = 0.3 + 1e-9, after.barycentric[(k + 2) % 3] = 0.3 - 1e-9;
      EXPECT_LT((fieldAtOwnAnchor(before, d) - fieldAtOwnAnchor(after, d)).norm(), 1e-7 * d.norm());
    }
  }
}

TEST(AddOthersAt, AddsTheFieldOfTheWholeSurface) {
  constexpr double kDifference = 3e-4;  // ownField()'s over its step, of own - d
  RandomTouch random;
  FieldScratch scratch(touchedOrgan());
  Touches touches(touchedOrgan());
  for (int trial = 0; trial < 200; ++trial) {
    const ContactPoint s = random.contactPoint();
    const Vec3 d = random.vector(0.004);
    const ToolPart part{s, d, trial % 2 == 0 ? d : Vec3(d + random.vector(0.004)), 0.7};
    std::array<FieldSource, 2> sources = ownField(touchedOrgan(), s, d, part.own);
    for (FieldSource& source : sources) source.gain *= part.gain;
    const std::array<ContactPoint, 3> at{random.contactPoint(), s, ContactPoint{}};
    std::vector<float> u(touchedOrgan().view().surface_positions.size());
    evaluateField(touchedOrgan(), sources, scratch, u);
    const Vec3 before = random.vector(0.001);
    std::array<Vec3, 3> found{before, before, before};
    addOthersAt(touchedOrgan(), std::span(&part, 1), touches, at, found);
    EXPECT_LT((found[0] - before - interpolated(u, at[0])).norm(),
              1e-6 * d.norm() + kDifference * (part.own - d).norm())
        << trial;
    EXPECT_EQ(found[1], before) << "its own anchor";
    EXPECT_EQ(found[2], before) << "no place";
  }
}

TEST(PatchMotion, AtRestIsTheLinearFieldOfOnePatchAveragedOverTheOther) {
  RandomTouch random;
  Touches touches(touchedOrgan());
  Touch &from = touches.all[0], &to = touches.all[1];
  for (int trial = 0; trial < 100; ++trial) {
    const ContactPoint a = random.contactPoint(), b = trial == 0 ? a : random.contactPoint();
    touchWith(touchedOrgan(), a, Vec3::Zero(), 0.0, from);
    to.patch.moveTo(touchedOrgan(), b);
    const Mat3 C = patchMotion(touchedOrgan(), from, to).slope() * stiffnessAt(a).inverse();
    const PatchNodes& patch = to.patch.nodes();
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      const double f = 1e-7;  // N, so small that the rest of the field vanishes
      const std::vector<float> u = field(a, f * stiffnessAt(a).inverse().col(axis));
      Vec3 expected = Vec3::Zero();
      for (std::size_t j = 0; j < patch.count; ++j)
        expected += patch.weight[j] / f *
                    Eigen::Map<const Eigen::Vector3f>(u.data() + 3 * patch.node[j]).cast<double>();
      EXPECT_LT((C.col(axis) - expected).norm(), 2e-6 * expected.norm() + 1e-9) << trial;
    }
  }
}

TEST(TouchField, AnswersAfterAPlaceWithoutAnAnswerInItsTriangle) {
  int tried = 0;
  for (std::int32_t t = 0; t < touchedOrgan().surface().triangles(); ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      ContactPoint corner{t, {0.0, 0.0, 0.0}}, inside{t, {0.4, 0.3, 0.3}};
      corner.barycentric[k] = 1.0;
      if (touchedOrgan().surface().mix(corner).count > 0 || touchedOrgan().surface().mix(inside).count == 0)
        continue;
      Touch touch(touchedOrgan()), fresh(touchedOrgan()), at(touchedOrgan());
      at.patch.moveTo(touchedOrgan(), inside);
      touchWith(touchedOrgan(), corner, Vec3(0.0, 0.0, -0.001), 0.0, touch);
      (void)patchMotion(touchedOrgan(), touch, at);
      for (const double depth : {0.001, 0.002, 0.003}) {
        touchWith(touchedOrgan(), inside, Vec3(0.0, 0.0, -depth), 0.0, touch);
        touchWith(touchedOrgan(), inside, Vec3(0.0, 0.0, -depth), 0.0, fresh);
        const Vec3 u = patchMotion(touchedOrgan(), touch, at).at(Vec3::Zero());
        EXPECT_EQ(u, patchMotion(touchedOrgan(), fresh, at).at(Vec3::Zero())) << t << ' ' << depth;
        tried += u.norm() > 0.0 ? 1 : 0;
      }
    }
  EXPECT_GT(tried, 0);
}

}  // namespace palpate::testing
