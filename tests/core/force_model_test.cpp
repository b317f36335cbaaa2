// SPDX-License-Identifier: Apache-2.0
// Models whose parameter is the force.
#include <algorithm>
#include <cmath>
#include <functional>

#include "load_driven.h"
#include "palpate/modelfile/model_file.h"

namespace palpate::testing {

namespace {

SyntheticOptions forceOptions(int order = 4) {
  return {.subdivisions = 2, .order = order, .parameters = Parameters::kForce};
}

const MetaModel& forceModel() {
  static const MetaModel model = loadSynthetic(forceOptions());
  return model;
}

/// A model whose data are spoiled before they are written.
MetaModel spoiled(const SyntheticOptions& options, const std::function<void(modelfile::ModelData&)>& spoil) {
  modelfile::ModelData data = syntheticModel(options);
  spoil(data);
  const TemporaryFile file("load-driven.h5");
  modelfile::writeModel(file.path(), data);
  return MetaModel::load(file.path());
}

std::vector<float> field(const MetaModel& model, const ContactPoint& s, const Vec3& parameter) {
  FieldScratch scratch(model);
  std::vector<float> u(model.view().surface_positions.size());
  const std::array<FieldSource, 1> source{FieldSource{s, parameter, 1.0}};
  evaluateField(model, source, scratch, u);
  return u;
}

}  // namespace

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
      if (std::abs(d.norm() - here.domain_radius) < 1e-5) continue;  // the kink
      const double h = 1e-6;
      for (Eigen::Index j = 0; j < 3; ++j) {
        (void)respond(forceModel(), s, d + h * Vec3::Unit(j), plus);
        (void)respond(forceModel(), s, d - h * Vec3::Unit(j), minus);
        EXPECT_LT((here.stiffness.col(j) - (plus.force - minus.force) / (2.0 * h)).norm(), 1e-2);
      }
      if (status == ResponseStatus::kClamped) {
        EXPECT_LT((here.stiffness * d).norm(), 1e-9) << "the force grows no more";
      }
      ++compared;
    }
    EXPECT_GT(compared, 30);
  }
}

TEST(ForceModel, BeyondTheDomainTheForceStaysAndTheDisplacementIsScaled) {
  Random random;
  for (int trial = 0; trial < 100; ++trial) {
    const ContactPoint s = random.contactPoint(forceModel());
    const Vec3 d = random.vector(1.0).normalized() * 0.05;
    const Response far = answerTo(forceModel(), s, d, ResponseStatus::kClamped);
    EXPECT_NEAR(far.force.norm(), forceOptions().domain_force, 1e-12);
    EXPECT_LT(far.displacement.cross(d).norm(), 1e-10 * d.norm() * far.displacement.norm());
    EXPECT_NEAR(far.displacement.norm(), far.domain_radius, 1e-12);
    const Response farther = answerTo(forceModel(), s, 1e200 * d, ResponseStatus::kClamped);
    EXPECT_LT((far.force - farther.force).norm(), 1e-9);
  }
}

TEST(ForceModel, AnswerIsContinuousAcrossTheDomainsEdge) {
  Random random;
  for (int trial = 0; trial < 50; ++trial) {
    const ContactPoint s = random.contactPoint(forceModel());
    const Vec3 edge =
        answerTo(forceModel(), s, random.vector(1.0).normalized() * 0.05, ResponseStatus::kClamped)
            .displacement;
    const Response in = answerTo(forceModel(), s, edge * (1.0 - 1e-7), ResponseStatus::kOk);
    const Response out = answerTo(forceModel(), s, edge * (1.0 + 1e-7), ResponseStatus::kClamped);
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

TEST(ForceModel, ADisplacementThatNoForceGivesIsAnsweredSafely) {
  // d = (f - 1.2 f^2) / k along x: it turns back at f = 0.42, long before f_max.
  const auto fold = [](modelfile::ModelData& data) {
    const std::size_t width = static_cast<std::size_t>(3 * MonomialBasis::size(2));
    for (std::size_t i = 0; i < data.contact_displacement.size(); i += width) {
      std::fill_n(data.contact_displacement.begin() + static_cast<std::ptrdiff_t>(i), width, 0.0);
      for (const std::size_t axis : {0U, 1U, 2U}) data.contact_displacement[i + 4 * axis] = 0.003;
      data.contact_displacement[i + 9] = -0.0036;  // xx of x
    }
  };
  const MetaModel model = spoiled(forceOptions(2), fold);
  Random random;
  const ContactPoint s = random.contactPoint(model);
  const double reachable = 0.003 / 4.8;  // m, at f / f_ref = 1 / 2.4
  const Response before = answerTo(model, s, {0.9 * reachable, 0.0, 0.0}, ResponseStatus::kOk);
  EXPECT_GT(before.force.x(), 0.0);
  const Response beyond = answerTo(model, s, {1.5 * reachable, 0.0, 0.0}, ResponseStatus::kClamped);
  EXPECT_TRUE(beyond.force.allFinite());
  EXPECT_GE(beyond.force.x(), before.force.x());
  EXPECT_EQ(beyond.stiffness, Mat3::Zero());
  EXPECT_LE(beyond.displacement.x(), reachable * (1.0 + 1e-9));
  EXPECT_GE(beyond.displacement.x(), (1.0 - 1.5 / 32.0) * reachable);
}

TEST(ForceModel, NumbersWithoutAnAnswerGiveNoForceAndAreFlagged) {
  for (const double number : {0.0, 1e308}) {
    const MetaModel model = spoiled(forceOptions(2), [&](modelfile::ModelData& data) {
      std::fill(data.contact_displacement.begin(), data.contact_displacement.end(), number);
    });
    Random random;
    const Response out =
        answerTo(model, random.contactPoint(model), {0.001, 0.0, -0.002}, ResponseStatus::kClamped);
    EXPECT_EQ(out.force, Vec3::Zero());
    EXPECT_TRUE(out.stiffness.allFinite() && out.displacement.allFinite());
  }
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
        sum += monomial[k] * double(v.modes_Y[(5 * monomial.size() + k) * v.modes() + mode]) *
               double(v.modes_X[mode * u.size() + i]);
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
  EXPECT_EQ(respondToLoad(forceModel(), s, f, out), ResponseStatus::kClamped);
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

TEST(ForceModel, PressIsAnsweredByTheModelsForceOnTheTool) {
  const MetaModel& model = forceModel();
  Driver driver(model);
  driver.settle(above(model, -0.002));
  for (double z = -0.002; z < 0.002; z += 1e-4) driver.at(above(model, z));
  const ToolResult& tool = driver.settle(above(model, 0.002));
  EXPECT_EQ(tool.flags, kInContact);
  const ContactPoint s = model.surface().closestPoint(Vec3(0.0, 0.0, 1.0)).s;
  const Response out = answerTo(model, s, vec(tool.displacement), ResponseStatus::kOk);
  EXPECT_GT(vec(tool.force).z(), 0.0);
  EXPECT_LT((vec(tool.force) + out.force).norm(), 1e-9 * out.force.norm());
  const std::vector<float> u = field(model, s, out.force);
  for (std::size_t i = 0; i < u.size(); ++i) ASSERT_NEAR(driver.work().displacement()[i], u[i], 1e-9);
}

TEST(ForceModel, PressBeyondTheDomainIsHeldAndFlagged) {
  const MetaModel& model = forceModel();
  Driver driver(model);
  driver.settle(above(model, -0.002));
  for (double z = -0.002; z < 0.015; z += 1e-4) driver.at(above(model, z));
  const ToolResult& tool = driver.settle(above(model, 0.015));
  EXPECT_EQ(tool.flags, kInContact | kBeyondDomain);
  EXPECT_NEAR(vec(tool.force).norm(), forceOptions().domain_force, 1e-9);
}

}  // namespace palpate::testing
