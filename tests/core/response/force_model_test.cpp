// SPDX-License-Identifier: Apache-2.0
// Models whose parameter is the force.
#include <algorithm>
#include <cmath>

#include "../load_driven.h"

namespace palpate::testing {

TEST(ForceModel, DisplacementIsGradientOfTheComplementaryEnergy) {
  Random random;
  const MetaModel& model = forceModel();
  for (std::size_t m = 0; m < model.view().positions(); m += 7) {
    const ContactPoint s = atPosition(model, m);
    const Vec3 f = random.inBall(forceOptions().domain_force), X = model.surface().position(s);
    const Vec3 d = underLoad(model, s, f).displacement;
    const double h = 1e-5;
    for (Eigen::Index i = 0; i < 3; ++i) {
      const double slope = (syntheticEnergy(forceOptions(), X, f + h * Vec3::Unit(i)) -
                            syntheticEnergy(forceOptions(), X, f - h * Vec3::Unit(i))) /
                           (2.0 * h);
      EXPECT_NEAR(d[i], slope, 1e-9);
    }
  }
}

TEST(ForceModel, ForceThatIsFoundGivesTheDisplacement) {
  Random random;
  for (int order = 1; order <= 6; ++order) {
    const MetaModel model = loadSynthetic(forceOptions(order));
    for (int trial = 0; trial < 200; ++trial) {
      const ContactPoint s = random.contactPoint(model);
      const Vec3 f = random.inBall(forceOptions().domain_force);
      const Vec3 d = underLoad(model, s, f).displacement;
      const Response found = answerTo(model, s, d, ResponseStatus::kOk);
      EXPECT_LT((found.force - f).norm(), 1e-9 * f.norm()) << "order " << order;
      EXPECT_LT((found.displacement - d).norm(), 1e-9 * d.norm());
      EXPECT_EQ(found.parameter, found.force);
    }
  }
}

TEST(ForceModel, StiffnessIsTheDerivativeOfForceInsideAndBeyondTheDomain) {
  Random random;
  for (const double size : {0.002, 0.02}) {
    int compared = 0;
    for (int trial = 0; trial < 50; ++trial) {
      const ContactPoint s = random.contactPoint(forceModel());
      const Vec3 d = random.vector(size);
      Response here, plus, minus;
      const ResponseStatus status = respond(forceModel(), s, d, here);
      const double h = 1e-6;
      for (Eigen::Index j = 0; j < 3; ++j) {
        const ResponseStatus ahead = respond(forceModel(), s, d + h * Vec3::Unit(j), plus);
        const ResponseStatus behind = respond(forceModel(), s, d - h * Vec3::Unit(j), minus);
        if (ahead != status || behind != status) continue;  // the kink at the domain's edge
        ++compared;
        EXPECT_LT((here.stiffness.col(j) - (plus.force - minus.force) / (2.0 * h)).norm(), 1e-2);
      }
      if (status == ResponseStatus::kBeyond) {
        EXPECT_LT((here.stiffness * d).norm(), 1e-9) << "the force grows no more";
      }
    }
    EXPECT_GT(compared, 140);
  }
}

TEST(ForceModel, BeyondTheDomainTheForceStaysAndTheDisplacementIsScaled) {
  Random random;
  for (int trial = 0; trial < 100; ++trial) {
    const ContactPoint s = random.contactPoint(forceModel());
    const Vec3 d = random.vector(1.0).normalized() * 0.05;
    const Response far = answerTo(forceModel(), s, d, ResponseStatus::kBeyond);
    EXPECT_NEAR(far.force.norm(), forceOptions().domain_force, 1e-12);
    EXPECT_LT(far.displacement.cross(d).norm(), 1e-10 * d.norm() * far.displacement.norm());
    EXPECT_NEAR(far.displacement.norm(), far.domain_radius, 1e-12);
    const Response farther = answerTo(forceModel(), s, 1e200 * d, ResponseStatus::kBeyond);
    EXPECT_LT((far.force - farther.force).norm(), 1e-9);
  }
}

TEST(ForceModel, AnswerIsContinuousAcrossTheDomainsEdge) {
  Random random;
  for (int trial = 0; trial < 50; ++trial) {
    const ContactPoint s = random.contactPoint(forceModel());
    const Vec3 edge =
        answerTo(forceModel(), s, random.vector(1.0).normalized() * 0.05, ResponseStatus::kBeyond)
            .displacement;
    const Response in = answerTo(forceModel(), s, edge * (1.0 - 1e-7), ResponseStatus::kOk);
    const Response out = answerTo(forceModel(), s, edge * (1.0 + 1e-7), ResponseStatus::kBeyond);
    EXPECT_LT((in.force - out.force).norm(), 1e-5);
    EXPECT_LT((in.displacement - out.displacement).norm(), 1e-8);
    EXPECT_NEAR(in.domain_radius, out.domain_radius, 1e-8);
  }
}

TEST(ForceModel, AtRestThereIsNoForceAndTheStiffnessIsThatOfTheLinearModel) {
  Random random;
  const ContactPoint s = random.contactPoint(forceModel());
  const Response rest = answerTo(forceModel(), s, Vec3::Zero(), ResponseStatus::kOk);
  EXPECT_EQ(rest.force, Vec3::Zero());
  EXPECT_GT(rest.domain_radius, 0.0);
  const Response tiny = answerTo(forceModel(), s, Vec3(1e-9, 0.0, 0.0), ResponseStatus::kOk);
  EXPECT_LT((tiny.force - 1e-9 * rest.stiffness.col(0)).norm(), 1e-3 * tiny.force.norm());
}

TEST(ForceModel, MixesCoefficientsOfDisplacementBetweenPositions) {
  const ContactPoint s = forceModel().surface().closestPoint(Vec3(0.7, 0.4, 0.5)).s;
  const Vec3 f(0.3, -0.2, 0.4);
  const PositionMix mix = forceModel().surface().mix(s);
  ASSERT_EQ(mix.count, 3);
  Vec3 d = Vec3::Zero();
  for (std::size_t b = 0; b < 3; ++b)
    d += mix.weight[b] *
         underLoad(forceModel(), atPosition(forceModel(), static_cast<std::size_t>(mix.position[b])), f)
             .displacement;
  EXPECT_LT((underLoad(forceModel(), s, f).displacement - d).norm(), 1e-15);
  EXPECT_LT((answerTo(forceModel(), s, d, ResponseStatus::kOk).force - f).norm(), 1e-9);
}

TEST(ForceModel, BeyondAFoldTheForceStaysNearTheFoldWithoutSawTeeth) {
  // d = 0.003 (x - 1.2 x^2) m along x, x = f / f_ref: it turns back at x = 1 / 2.4, long before f_max.
  const MetaModel model = spoiled(forceOptions(2), fold);
  Random random;
  const ContactPoint s = random.contactPoint(model);
  const double f_fold = forceOptions().reference_force / 2.4, d_fold = 0.003 / 4.8, step = 0.0005;
  Vec3 last = answerTo(model, s, {0.9 * d_fold, 0.0, 0.0}, ResponseStatus::kOk).force;
  EXPECT_NEAR(last.x(), f_fold * (1.0 - std::sqrt(0.1)), 1e-9);
  for (double q = 0.9 + step; q < 3.0; q += step) {
    Response out;
    const ResponseStatus status = respond(model, s, {q * d_fold, 0.0, 0.0}, out);
    // Of the fold itself: 1 - sqrt(1 - q) has changed by the root of the step at its end.
    EXPECT_LT((out.force - last).norm(), (q < 1.01 ? 1.1 * std::sqrt(step) : 1e-2) * f_fold) << q;
    last = out.force;
    if (q < 1.001) continue;
    EXPECT_EQ(status, ResponseStatus::kBeyond) << q;
    EXPECT_EQ(out.stiffness, Mat3::Zero());
    EXPECT_NEAR(out.force.x(), f_fold, 0.02 * f_fold) << q;
    EXPECT_NEAR(out.displacement.x(), d_fold, 1e-3 * d_fold);
  }
}

TEST(ForceModel, BehindAFoldAPrescribedForceHasNoStiffness) {
  const MetaModel model = spoiled(forceOptions(2), fold);
  Random random;
  const ContactPoint s = random.contactPoint(model);
  EXPECT_GT(underLoad(model, s, {0.32, 0.0, 0.0}).stiffness.trace(), 0.0);
  EXPECT_EQ(underLoad(model, s, {0.35, 0.0, 0.0}).stiffness, Mat3::Zero()) << "dd/df < 0 along x";
}

TEST(ForceModel, AWeakPositionGovernsTheDomainAndEdgesAreContinuous) {
  const std::size_t weak = 5;
  const MetaModel model = spoiled(forceOptions(), [&](modelfile::ModelData& data) {
    data.contact_domain_radius[weak] = 0.1;  // the others have 1.2 N
  });
  const auto node = model.view().contact_node[weak];
  for (int triangle = 0; triangle < model.surface().triangles(); ++triangle) {
    const auto* const corner = model.view().surface_triangles.data() + 3 * triangle;
    const auto at = static_cast<std::size_t>(std::find(corner, corner + 3, node) - corner);
    if (at == 3 || model.surface().mix({triangle, {0.3, 0.3, 0.4}}).count != 3) continue;
    const auto f_max = [&](double weight) {
      ContactPoint s{triangle, {(1.0 - weight) / 2, (1.0 - weight) / 2, (1.0 - weight) / 2}};
      s.barycentric[at] = weight;
      return underLoad(model, s, {0.0, 0.0, 5.0}).force.norm();
    };
    EXPECT_NEAR(f_max(1.0), 0.1, 1e-12);
    EXPECT_NEAR(f_max(0.5), 1.0 / (0.5 / 0.1 + 0.5 / 1.2), 1e-12);
    EXPECT_NEAR(f_max(1e-6), f_max(0.0), 2e-5);
  }
}

TEST(ForceModel, NumbersWithoutAnAnswerAreNoForceAndAreFlagged) {
  for (const double number : {0.0, 1e308}) {
    const MetaModel model = spoiled(forceOptions(2), [&](modelfile::ModelData& data) {
      std::fill(data.contact_displacement.begin(), data.contact_displacement.end(), number);
    });
    Random random;
    const Response out =
        answerTo(model, random.contactPoint(model), {0.001, 0.0, -0.002}, ResponseStatus::kBeyond);
    EXPECT_TRUE(out.force.array().isNaN().all());
    EXPECT_EQ(out.stiffness, Mat3::Zero());
    EXPECT_EQ(out.displacement, Vec3::Zero());
    EXPECT_EQ(out.parameter, Vec3::Zero());
    EXPECT_EQ(out.domain_radius, 0.0);
  }
}

TEST(ForceModel, ADisplacementThatIsNoNumberGivesNoForce) {
  Random random;
  const Response out = answerTo(forceModel(), random.contactPoint(forceModel()), Vec3::Constant(std::nan("")),
                                ResponseStatus::kBeyond);
  EXPECT_EQ(out.force, Vec3::Zero());
  EXPECT_EQ(out.stiffness, Mat3::Zero());
}

TEST(ForceModel, FieldIsThatOfTheForce) {
  Random random;
  const MetaModel& model = forceModel();
  const ContactPoint s = atPosition(model, 5);
  const Vec3 f(0.3, -0.2, 0.4);
  const std::vector<float> u = field(model, s, f);
  const ModelView& v = model.view();
  const MonomialBasis basis(forceOptions().order);
  std::vector<double> monomial(static_cast<std::size_t>(basis.size()));
  basis.evaluate(f / forceOptions().reference_force, monomial);
  for (std::size_t i = 0; i < u.size(); i += 17) {
    double sum = 0.0;
    for (std::size_t k = 0; k < monomial.size(); ++k)
      for (std::size_t mode = 0; mode < v.modes(); ++mode)
        sum += monomial[k] * double(v.modes_Y_scale[5 * monomial.size() + k]) *
               v.modes_Y[(5 * monomial.size() + k) * v.modes() + mode] * double(v.modes_X_scale[mode]) *
               v.modes_X[i * v.modes() + mode];
    EXPECT_NEAR(u[i], sum, 1e-8);
  }
  FieldScratch scratch(model);
  std::vector<float> imposed(u.size());
  evaluateField(model, s, underLoad(model, s, f).displacement, scratch, imposed);
  for (std::size_t i = 0; i < u.size(); ++i) ASSERT_NEAR(u[i], imposed[i], 1e-9);
}

TEST(ForceModel, APrescribedForceBeyondTheDomainIsClamped) {
  Random random;
  const ContactPoint s = random.contactPoint(forceModel());
  const Vec3 f = random.vector(1.0).normalized() * 3.0;
  Response out;
  EXPECT_EQ(respondToLoad(forceModel(), s, f, out), ResponseStatus::kBeyond);
  EXPECT_LT((out.force - f * 0.4).norm(), 1e-12);
  EXPECT_EQ(out.displacement, underLoad(forceModel(), s, out.force).displacement);
  EXPECT_NEAR(out.domain_radius, out.displacement.norm(), 1e-12);
}

TEST(ForceModel, ADisplacementModelHasNoAnswerToALoad) {
  static const MetaModel model = loadSynthetic({.subdivisions = 2});
  Random random;
  Response out;
  EXPECT_EQ(respondToLoad(model, random.contactPoint(model), Vec3(0.0, 0.0, -0.1), out),
            ResponseStatus::kNoAnswer);
}

}  // namespace palpate::testing
