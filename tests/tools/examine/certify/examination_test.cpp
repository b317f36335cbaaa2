// SPDX-License-Identifier: Apache-2.0
#include "tools/examine/certify/examination.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <limits>

#include "../query/box_model.h"
#include "core/response/patch_response.h"
#include "tools/examine/certify/certificate.h"
#include "tools/examine/certify/certify_error.h"
#include "tools/examine/certify/energy_asymmetry.h"
#include "tools/examine/certify/error_plot.h"

namespace palpate::certify {
namespace {

using program::Json;
using query::test::BoxModel;

constexpr double kExaminedTravel = 0.002;
constexpr TouchRange kRange{kExaminedTravel, {}, false};
constexpr std::uint64_t kSeed = 1;  // not that of the content, which another processor rounds otherwise

/// The model of the box, and the same one spoiled: its forces are too large by 2 %.
class Box : public ::testing::Test {
 protected:
  static constexpr double kTooLarge = 1.02;
  inline static std::unique_ptr<BoxModel> box_;
  inline static std::unique_ptr<MetaModel> spoiled_;

  static void SetUpTestSuite() {
    box_ = std::make_unique<BoxModel>("stable-neo-hookean", 2);
    modelfile::ModelData data = query::test::boxModelData(box_->folder.path(), "stable-neo-hookean", 2);
    for (auto* numbers : {&data.contact_force, &data.contact_stiffness})
      for (auto& number : *numbers) number *= kTooLarge;
    modelfile::writeModel(box_->folder / "spoiled.h5", data);
    spoiled_ = std::make_unique<MetaModel>(MetaModel::load(box_->folder / "spoiled.h5"));
  }
  static void TearDownTestSuite() {
    spoiled_.reset();
    box_.reset();
  }

  static Examination examined(const MetaModel& model, std::size_t samples, int threads = 2) {
    TouchSampler touches(model, kRange, kSeed);
    return examine(model, box_->organ, touches, kExaminedTravel, {samples, threads});
  }
  static Json certificate(const MetaModel& model, std::size_t samples) {
    return certificateOf(model, {{kExaminedTravel, "asked for"}, kRange, kSeed}, examined(model, samples));
  }
};

TEST_F(Box, ReferenceIsTheFullSolution) {
  TouchSampler touches(box_->model, {0.004, {}, false}, 11);
  const std::vector<Touch> asked{touches.next(), touches.next(), touches.next()};
  ReferenceSolver reference(box_->organ, box_->model.attributes().patch_radius, 2);
  const std::vector<Eigen::VectorXd> starts = reference.starts(asked);
  for (std::size_t i = 0; i < asked.size(); ++i) {
    const auto found = reference.solve(std::span(&asked[i], 1), starts[i], static_cast<int>(i % 2));
    ASSERT_TRUE(found);
    const query::FullSolution truth = box_->solve({asked[i].s, asked[i].position, 0}, asked[i].d);
    EXPECT_LT((found->state.u - truth.state.u).cwiseAbs().maxCoeff(), 1e-7 * asked[i].d.norm());
    EXPECT_LT((found->state.force - truth.state.force).norm(), 1e-7 * truth.state.force.norm());
    EXPECT_NEAR(found->min_det_f, truth.min_det_f, 1e-7);
    EXPECT_LT((starts[i] - truth.state.u).cwiseAbs().maxCoeff(), 0.2 * asked[i].d.norm());
  }
}

TEST_F(Box, ASolutionThatCannotBeFoundIsNone) {
  Touch touch = TouchSampler(box_->model, kRange, 1).next();
  const Eigen::VectorXd rest = Eigen::VectorXd::Zero(3 * box_->organ.body.nodeCount());
  touch.d = Vec3::Constant(std::numeric_limits<double>::quiet_NaN());
  ReferenceSolver reference(box_->organ, box_->model.attributes().patch_radius, 1);
  EXPECT_FALSE(reference.solve(std::span(&touch, 1), rest, 0));
}

TEST_F(Box, AGoodModelIsFoundGood) {
  const Json c = certificate(box_->model, 59);
  EXPECT_EQ(c["samples"], 59);
  EXPECT_EQ(c["not_converged"], 0);
  EXPECT_LT(c["force_error"]["p50"].get<double>(), 0.005);
  EXPECT_LT(c["force_error"]["max"].get<double>(), 0.1);  // the box is coarse between nodes
  EXPECT_EQ(c["force_error"]["bound_95_95"], c["force_error"]["max"]);
  EXPECT_EQ(c["field_error"]["bound_95_95"], c["field_error"]["max"]);
  EXPECT_LT(c["force_error"]["p50"].get<double>(), c["force_error"]["p95"].get<double>());
  EXPECT_GT(c["min_det_f"].get<double>(), 0.3);
  EXPECT_LT(c["min_det_f"].get<double>(), 1.0);
  EXPECT_EQ(c["drawn"].get<int>(), 59 + c["beyond_domain"].get<int>());
  TouchSampler others(box_->model, kRange, 99);
  int within = 0;
  for (int i = 0; i < 4000; ++i) within += isBeyond(box_->model, others.next()) ? 0 : 1;
  EXPECT_NEAR(c["certified_area_fraction"].get<double>(), within / 4000.0, 0.03);
  EXPECT_TRUE(c["mesh_error"].isNull());
}

TEST_F(Box, ForcesTooLargeByTwoPercentAreFoundSo) {
  const auto found = [](const MetaModel& model) {
    TouchSampler touches(model, kRange, kSeed);
    return examine(model, box_->organ, touches, kExaminedTravel, {59, 2});
  };
  const Examination good = found(box_->model), spoiled = found(*spoiled_);
  ASSERT_EQ(good.findings.size(), spoiled.findings.size());
  for (std::size_t i = 0; i < good.findings.size(); ++i)
    EXPECT_NEAR(spoiled.findings[i].force_error, kTooLarge - 1.0,
                kTooLarge * good.findings[i].force_error + 1e-6);
  const Drawing drawing{{kExaminedTravel, "asked for"}, kRange, kSeed};
  const Json c = certificateOf(*spoiled_, drawing, spoiled);
  EXPECT_NEAR(c["force_error"]["p50"].get<double>(), kTooLarge - 1.0, 0.003);
  EXPECT_GT(c["force_error"]["bound_95_95"].get<double>(), kTooLarge - 1.0);
  EXPECT_NE(spoiled_->digest(), box_->model.digest());
}

TEST_F(Box, ATouchWithoutASolutionIsNotCertified) {
  Examination found = examined(box_->model, 5, 2);
  const Drawing drawing{{kExaminedTravel, ""}, kRange, 1};
  const auto share = [&] {
    return certificateOf(box_->model, drawing, found)["certified_area_fraction"].get<double>();
  };
  const double solved = share();
  ASSERT_GT(solved, 0.0);
  ASSERT_EQ(found.count(Outcome::kWithin), 5U);
  const auto within = std::find_if(found.findings.begin(), found.findings.end(),
                                   [](const Finding& f) { return f.outcome == Outcome::kWithin; });
  within->outcome = Outcome::kNotSolved;
  EXPECT_NEAR(share(), 0.8 * solved, 1e-12);
}

TEST_F(Box, TooFewSamplesClaimNoBound) {
  const Json c = certificate(box_->model, 58);
  EXPECT_EQ(c["samples"], 58);
  EXPECT_TRUE(c["force_error"]["bound_95_95"].isNull());
  EXPECT_TRUE(c["field_error"]["bound_95_95"].isNull());
  EXPECT_GT(c["force_error"]["max"].get<double>(), 0.0);
}

TEST_F(Box, AnswersDoNotDependOnTheThreads) {
  EXPECT_EQ(certificateOf(box_->model, {{kExaminedTravel, ""}, kRange, 1}, examined(box_->model, 5, 1)),
            certificateOf(box_->model, {{kExaminedTravel, ""}, kRange, 1}, examined(box_->model, 5, 2)));
}

TEST_F(Box, WhatIsBeyondTheDomainIsCountedApart) {
  const double d_max = box_->model.view().contact_domain_radius[0];
  const double travel = 1.5 * d_max;
  TouchSampler touches(box_->model, {travel, {}, false}, 2);
  const Examination found = examine(box_->model, box_->organ, touches, travel, {10, 2});
  EXPECT_EQ(found.count(Outcome::kWithin), 10U);
  EXPECT_GT(found.count(Outcome::kBeyond), 0U);
  for (const Finding& finding : found.findings)
    EXPECT_EQ(finding.flagged,
              finding.touch.d.norm() >
                  query::ask(box_->model, {finding.touch.s, finding.touch.position, 0}, finding.touch.d)
                      .response.domain_radius);
}

TEST_F(Box, ATravelThatIsBeyondEverywhereCertifiesNothing) {
  TouchSampler touches(box_->model, {0.1, 0.1, false}, 2);
  const Examination found = examine(box_->model, box_->organ, touches, 0.1, {1, 2});
  EXPECT_EQ(found.findings.size(), 20U);
  const Json c = certificateOf(box_->model, {{0.1, ""}, {0.1, 0.1, false}, 2}, found);
  EXPECT_EQ(c["samples"], 0);
  EXPECT_EQ(c["certified_area_fraction"], 0.0);
  EXPECT_TRUE(c["force_error"].isNull());
  EXPECT_TRUE(c["min_det_f"].isNull());
}

TEST_F(Box, ForcesThatOverflowAreRefusedByTheTouch) {
  modelfile::ModelData data = query::test::boxModelData(box_->folder.path(), "stable-neo-hookean", 2);
  for (auto& number : data.contact_force) number *= 1e300;
  modelfile::writeModel(box_->folder / "huge.h5", data);
  const MetaModel huge = MetaModel::load(box_->folder / "huge.h5");
  try {
    (void)examined(huge, 3);
    FAIL() << "no error";
  } catch (const CertifyError& error) {
    EXPECT_THAT(error.what(), ::testing::StartsWith("the touch at ("));
    EXPECT_THAT(error.what(), ::testing::HasSubstr("expected finite answers"));
  }
}

TEST_F(Box, ErrorsThatAreNotFiniteAreRefused) {
  const Touch touch = TouchSampler(box_->model, kRange, 1).next();
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN(),
                   kInfinity = std::numeric_limits<double>::infinity();
  EXPECT_NO_THROW(requireFinite(touch, 0.1, 0.2));
  EXPECT_THROW(requireFinite(touch, kNan, 0.2), CertifyError);
  EXPECT_THROW(requireFinite(touch, 0.1, kInfinity), CertifyError);
  const query::FullSolution truth = box_->solve({touch.s, touch.position, 0}, touch.d);
  std::vector<float> field = query::ask(box_->model, {touch.s, touch.position, 0}, touch.d).field;
  EXPECT_LT(fieldError(field, truth, box_->organ, touch.d.norm()), 1.0);
  field[4] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(fieldError(field, truth, box_->organ, touch.d.norm()), kInfinity);
}

TEST_F(Box, ForcesOfTheFileHaveAnEnergy) {
  EXPECT_LT(energyAsymmetry(box_->model), 1e-10);
}

TEST_F(Box, ForcesOfTheFileWithoutAnEnergyAreFoundSo) {
  modelfile::ModelData data = query::test::boxModelData(box_->folder.path(), "stable-neo-hookean", 2);
  const std::size_t numbers = data.contact_force.size() / data.contact_domain_radius.size();
  // f_x has 2 % more of d_y: half of that is no gradient, (d_y, -d_x, 0) times 1 % of K_yy.
  const double K = data.contact_force[4], more = 0.02 * K;
  data.contact_force[3] += more;
  modelfile::writeModel(box_->folder / "curl.h5", data);
  const MetaModel curl = MetaModel::load(box_->folder / "curl.h5");
  ASSERT_GT(numbers, 9U);
  ASSERT_GT(data.contact_domain_radius[0], 0.0);
  EXPECT_GT(energyAsymmetry(curl), 0.002);
  EXPECT_LT(energyAsymmetry(curl), 0.01);
}

TEST_F(Box, TheFloorOfTheForceErrorIsOfTheForceAtTheTravel) {
  Finding finding;
  finding.touch = TouchSampler(box_->model, {kExaminedTravel, 1e-6, false}, 4).next();
  const query::FullSolution truth =
      box_->solve({finding.touch.s, finding.touch.position, 0}, finding.touch.d);
  compare(*spoiled_, box_->organ, truth, kExaminedTravel, finding);
  Response at_touch, at_travel;
  ASSERT_EQ(respond(*spoiled_, finding.touch.s, finding.touch.d, at_touch), ResponseStatus::kOk);
  (void)respond(*spoiled_, finding.touch.s, kExaminedTravel * finding.touch.d.normalized(), at_travel);
  ASSERT_LT(truth.state.force.norm(), 0.05 * at_travel.force.norm());  // so short is the touch
  EXPECT_NEAR(finding.force_error,
              (at_touch.force - truth.state.force).norm() / (0.05 * at_travel.force.norm()), 1e-9);
}

TEST_F(Box, ThePlotHasTwoMarksForEachTouch) {
  const Examination found = examined(box_->model, 4);
  const std::string svg = errorPlot(found.findings).render();
  std::size_t circles = 0;
  for (std::size_t at = svg.find("<circle"); at != std::string::npos; at = svg.find("<circle", at + 1))
    ++circles;
  EXPECT_EQ(circles,
            found.count(Outcome::kWithin) + found.count(Outcome::kBeyond) + 2U);  // two in the legend
  EXPECT_EQ(svg.find("nan"), std::string::npos);
}

}  // namespace
}  // namespace palpate::certify
