// SPDX-License-Identifier: Apache-2.0
#include "core/response/patch_response.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <functional>

#include "../spoiled_model.h"
#include "random_touch.h"

namespace palpate::testing {

namespace {

struct Organ {
  const MetaModel& model;
  const SyntheticOptions& options;
};

/// The organ of all tests, and one with the force of the highest degree. They have one surface.
std::array<Organ, 2> organs() {
  static const SyntheticOptions steep{
      .subdivisions = 2, .order = 4, .force_order = kMostForceOrder, .series_radius = 0.01};
  static const MetaModel model = loadSynthetic(steep);
  return {{{touchedOrgan(), options()}, {model, steep}}};
}

/// What degree 2 of W is at X, J.
double linear(const SyntheticOptions& o, const Vec3& X, const Vec3& d) {
  const double along = X.normalized().dot(d);
  return 0.5 * o.stiffness * (d.squaredNorm() + 0.5 * along * along);
}

/// W of the organ's closed form: the patch's own stiffness, and what is beyond degree 2 mixed as the model mixes it.
double mixedEnergy(const Organ& of, const ContactPoint& s, const Vec3& d) {
  const Stencil mix = of.model.mixing().at(of.model.surface(), s);
  const ModelView& v = of.model.view();
  PatchStiffness::Value stiffness;
  of.model.stiffness().at(of.model.surface(), s, stiffness);
  double energy = 0.5 * d.dot(stiffness.K * d);
  for (std::size_t b = 0; b < mix.count; ++b) {
    const auto node = static_cast<std::size_t>(v.contact_node[static_cast<std::size_t>(mix.position[b])]);
    const Vec3 X = Eigen::Map<const Vec3>(v.surface_positions.data() + 3 * node);
    energy += mix.weight[b] * (syntheticEnergy(of.options, X, d) - linear(of.options, X, d));
  }
  return energy;
}

}  // namespace

TEST(Response, StiffnessAtANodeIsTheSumOverDRef) {
  constexpr double kRounding = 1e-15;
  const ModelView& v = touchedOrgan().view();
  const MonomialBasis basis(options().force_order);
  std::vector<Vec3> gradient(static_cast<std::size_t>(basis.size()));
  for (std::size_t m = 0; m < v.positions(); m += 5) {
    const Vec3 d(0.0011, -0.0023, -0.0037);
    basis.gradient(d / options().reference_displacement, gradient);
    Mat3 sum = Mat3::Zero();
    const ContactPoint s = touchedOrgan().surface().atNode(v.contact_node[m]);
    PatchStiffness::Value stiffness;
    touchedOrgan().stiffness().at(touchedOrgan().surface(), s, stiffness);
    for (std::size_t k = 0; k < gradient.size(); ++k) {
      const Vec3 f = k < 3 ? Vec3(options().reference_displacement * stiffness.K.col(Eigen::Index(k)))
                           : Eigen::Map<const Vec3>(v.contact_force.data() + 3 * (m * gradient.size() + k));
      sum += f * gradient[k].transpose();
    }
    Response out;
    ASSERT_EQ(respond(touchedOrgan(), s, d, out), ResponseStatus::kOk);
    sum /= options().reference_displacement;
    EXPECT_LT((out.stiffness - sum).norm(), kRounding * sum.norm());
    EXPECT_LT((out.stiffness - out.stiffness.transpose()).norm(), kRounding * sum.norm());
  }
}

TEST(Response, ForceIsAGradientEvenWhereTheFileHasOneThatIsNot) {
  const MetaModel model = spoiled(options(), [](modelfile::ModelData& data) {
    for (std::size_t i = 0; i < data.contact_force.size(); i += 2) data.contact_force[i] *= 1.1;
  });
  RandomTouch random;
  for (int trial = 0; trial < 50; ++trial) {
    const PatchResponse patch(model, random.contactPoint());
    const Vec3 d = random.vector(0.004);
    Response out;
    ASSERT_EQ(patch.at(d, out), ResponseStatus::kOk);
    EXPECT_LT((out.stiffness - out.stiffness.transpose()).norm(), 1e-14 * out.stiffness.norm());
    for (Eigen::Index i = 0; i < 3; ++i) {
      const Vec3 step = 1e-6 * Vec3::Unit(i);
      EXPECT_NEAR(out.force[i], (patch.energy(d + step) - patch.energy(d - step)) / 2e-6, 1e-6);
    }
  }
}

TEST(Response, ForceIsGradientOfEnergy) {
  RandomTouch random;
  for (const Organ& of : organs())
    for (int trial = 0; trial < 50; ++trial) {
      const ContactPoint s = random.contactPoint();
      const Vec3 d = random.vector(0.004);
      Response out;
      ASSERT_EQ(respond(of.model, s, d, out), ResponseStatus::kOk);
      const double h = 1e-6;
      for (Eigen::Index i = 0; i < 3; ++i) {
        const double slope =
            (mixedEnergy(of, s, d + h * Vec3::Unit(i)) - mixedEnergy(of, s, d - h * Vec3::Unit(i))) /
            (2.0 * h);
        EXPECT_NEAR(out.force[i], slope, 1e-6) << of.options.force_order;
      }
      EXPECT_NEAR(PatchResponse(of.model, s).energy(d), mixedEnergy(of, s, d), 1e-12);
    }
}

TEST(Response, StiffnessIsTheDerivativeOfTheForceOfAnyDegree) {
  RandomTouch random;
  for (const Organ& of : organs())
    for (int trial = 0; trial < 50; ++trial) {
      const PatchResponse patch(of.model, random.contactPoint());
      const Vec3 d = random.vector(0.004);
      Response out, plus, minus;
      ASSERT_EQ(patch.at(d, out), ResponseStatus::kOk);
      const double h = 1e-6;
      for (Eigen::Index i = 0; i < 3; ++i) {
        ASSERT_EQ(patch.at(d + h * Vec3::Unit(i), plus), ResponseStatus::kOk);
        ASSERT_EQ(patch.at(d - h * Vec3::Unit(i), minus), ResponseStatus::kOk);
        const Vec3 slope = (plus.force - minus.force) / (2.0 * h);
        EXPECT_LT((out.stiffness.col(i) - slope).norm(), 1e-6 * out.stiffness.norm());
      }
    }
}

TEST(Response, ForceIsGradientOfTheEnergyThatIsReported) {
  RandomTouch random;
  for (int trial = 0; trial < 100; ++trial) {
    const PatchResponse patch(touchedOrgan(), random.contactPoint());
    const Vec3 d = random.vector(0.004);
    Response out;
    ASSERT_EQ(patch.at(d, out), ResponseStatus::kOk);
    for (Eigen::Index i = 0; i < 3; ++i) {
      const double h = 1e-6;
      const double slope =
          (patch.energy(d + h * Vec3::Unit(i)) - patch.energy(d - h * Vec3::Unit(i))) / (2.0 * h);
      EXPECT_NEAR(out.force[i], slope, 1e-6);
    }
  }
}

TEST(Response, EnergySlopeIsTheDerivativeOfTheEnergyAsTheAnchorMoves) {
  RandomTouch random;
  for (int trial = 0; trial < 50; ++trial) {
    const ContactPoint s = random.contactPoint();
    const Vec3 d = random.vector(0.004);
    if (!touchedOrgan().surface().complete(s.triangle)) continue;  // mixed linearly, and no anchor goes there
    const PatchResponse here(touchedOrgan(), s);
    const double h = 1e-6;
    for (std::size_t k = 0; k < 3; ++k) {
      ContactPoint plus = s, minus = s;
      for (const double way : {1.0, -1.0}) {
        ContactPoint& there = way > 0.0 ? plus : minus;
        there.barycentric[k] += way * h;
        there.barycentric[(k + 1) % 3] -= way * h;
      }
      const double slope =
          (PatchResponse(touchedOrgan(), plus).energy(d) - PatchResponse(touchedOrgan(), minus).energy(d)) /
          (2.0 * h);
      const Vec3 found = here.energySlope(d);
      EXPECT_NEAR(found[Eigen::Index(k)] - found[Eigen::Index((k + 1) % 3)], slope,
                  1e-8 * here.energy(d) + 1e-12);
    }
  }
}

TEST(Response, HasNoAnswerOnTheFixedPart) {
  const ContactPoint s = touchedOrgan().surface().closestPoint(Vec3(0.0, 0.0, -1.0)).s;
  Response out;
  EXPECT_EQ(respond(touchedOrgan(), s, Vec3(0.0, 0.0, 0.001), out), ResponseStatus::kNoAnswer);
  EXPECT_EQ(out.force, Vec3::Zero());
  EXPECT_EQ(respond(touchedOrgan(), ContactPoint{}, Vec3::Zero(), out), ResponseStatus::kNoAnswer);
  const auto still = field(s, Vec3(0.0, 0.0, 0.001));
  ASSERT_FALSE(still.empty());
  for (const float u : still) ASSERT_EQ(u, 0.0F);
}

TEST(Response, ZeroDisplacementGivesZeroForceAndFiniteStiffness) {
  RandomTouch random;
  Response out;
  EXPECT_EQ(respond(touchedOrgan(), random.contactPoint(), Vec3::Zero(), out), ResponseStatus::kOk);
  EXPECT_EQ(out.force, Vec3::Zero());
  EXPECT_GT(out.stiffness.trace(), 0.0);
}

TEST(Response, StatusHasAName) {
  EXPECT_EQ(toString(ResponseStatus::kOk), "ok");
  EXPECT_EQ(toString(ResponseStatus::kBeyond), "beyond_domain");
  EXPECT_EQ(toString(ResponseStatus::kNoAnswer), "not_accessible");
}

// The three parts follow an anchor over the surface without a step: halving the walk's stride halves the
// largest change.
TEST(Field, ForceAndFieldAreContinuousWhileTheAnchorCrossesEdgesAndNodes) {
  const Vec3 d(0.001, 0.002, -0.003);
  // A circle of latitude, and a meridian through the top node of the sphere.
  const auto latitude = [](double t) { return Vec3(std::cos(t), std::sin(t), 0.3); };
  const auto meridian = [](double t) { return Vec3(std::sin(t - 0.5), 0.0, std::cos(t - 0.5)); };
  for (const std::function<Vec3(double)>& path :
       {std::function<Vec3(double)>(latitude), std::function<Vec3(double)>(meridian)}) {
    const auto largestStep = [&](int steps, double& force_step) {
      std::vector<float> last;
      Vec3 last_force = Vec3::Zero();
      double field_step = 0.0;
      int triangle = -1, crossings = 0;
      force_step = 0.0;
      for (int i = 0; i <= steps; ++i) {
        const ContactPoint s = touchedOrgan().surface().closestPoint(path(1.0 * i / steps)).s;
        Response out;
        EXPECT_NE(respond(touchedOrgan(), s, d, out), ResponseStatus::kNoAnswer);
        const std::vector<float> u = field(s, d);
        if (i > 0) {
          field_step = std::max(field_step, largestDifference(u, last));
          force_step = std::max(force_step, (out.force - last_force).norm());
          crossings += s.triangle != triangle ? 1 : 0;
        }
        triangle = s.triangle;
        last = u;
        last_force = out.force;
      }
      EXPECT_GT(crossings, 4);
      return field_step;
    };
    double coarse_force = 0.0, fine_force = 0.0;
    const double coarse = largestStep(400, coarse_force), fine = largestStep(3200, fine_force);
    EXPECT_LT(fine, 0.2 * coarse);
    EXPECT_LT(fine_force, 0.2 * coarse_force);
  }
}

// A replay of a session finds d at another place in memory than the session did.
TEST(Response, IsTheSameBitForBitWhereverItsDisplacementLies) {
  RandomTouch random;
  struct alignas(16) Places {
    Vec3 aligned;
    double gap[2];
    Vec3 shifted;
  };
  static_assert(offsetof(Places, shifted) % 16 == 8);
  Places d;
  for (int i = 0; i < 2000; ++i) {
    d.aligned = d.shifted = random.vector(0.03);  // mostly beyond the domain
    const ContactPoint s = random.contactPoint();
    Response here, there;
    (void)respond(touchedOrgan(), s, d.aligned, here);
    (void)respond(touchedOrgan(), s, d.shifted, there);
    ASSERT_EQ(here.stiffness, there.stiffness) << i;
    ASSERT_EQ(here.force, there.force) << i;
  }
}

}  // namespace palpate::testing
