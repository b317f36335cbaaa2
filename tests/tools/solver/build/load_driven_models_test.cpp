// SPDX-License-Identifier: Apache-2.0
// Every load-driven method from a case to a file to an answer, against full solutions.
#include <gtest/gtest.h>

#include <filesystem>
#include <random>

#include "core/model/field_evaluation.h"
#include "core/model/meta_model.h"
#include "core/response/patch_response.h"
#include "core/response/response.h"
#include "palpate/testing/files.h"
#include "tools/mesh/box_mesh.h"
#include "tools/modelfile/write_model.h"
#include "tools/solver/build/build_model.h"
#include "tools/solver/build/solver_setup.h"
#include "tools/solver/fem/newton.h"

namespace palpate::solver {
namespace {

/// A small block held at x = 0.
class Block : public ::testing::Test {
 protected:
  Block() : organ_(mesh::makeBox(Vec3(0.06, 0.05, 0.04), {6, 5, 4})) {
    for (std::int32_t node = 0; node < static_cast<std::int32_t>(organ_.nodes.size()); ++node) {
      const double x = organ_.nodes[static_cast<std::size_t>(node)].x();
      if (x < 1e-9) organ_.groups["fixed"].push_back(node);
      if (x > 0.02) organ_.groups["accessible"].push_back(node);
    }
    c_.mesh = "block";
    c_.accessible = "accessible";
    c_.nu = 0.4;
    c_.modes = 2000;  // as many as there can be
  }

  MetaModel solve(BuildReport& report) {
    modelfile::ModelData data =
        buildModel(c_, organ_, {2, std::filesystem::temp_directory_path(), true}, report);
    data.attributes.provenance = "{}";
    modelfile::writeModel(file_.path(), data);
    setup_ = std::make_unique<SolverSetup>(c_, organ_);
    EXPECT_GT(accessible(), 50U) << "too few positions to compare at";
    return MetaModel::load(file_.path());
  }
  MetaModel solve() {
    BuildReport report;
    return solve(report);
  }

  /// An accessible position, as the model and as the solver know it.
  [[nodiscard]] ContactPoint touch(std::size_t position) const {
    const ContactPoint s = setup_->surface.atNode(setup_->positions.nodes[position]);
    ContactPoint contact;
    contact.triangle = s.triangle;
    contact.barycentric = s.barycentric;
    return contact;
  }
  [[nodiscard]] std::size_t accessible() const {
    return static_cast<std::size_t>(std::count(setup_->positions.accessible.begin(),
                                               setup_->positions.accessible.end(), std::uint8_t{1}));
  }

  [[nodiscard]] Eigen::VectorXd newton(std::size_t position, const Vec3& f) const {
    Eigen::VectorXd load = Eigen::VectorXd::Zero(3 * setup_->model.nodeCount());
    setup_->positions.patches[position].addForce(f, load);
    return NewtonSolver(setup_->model).solveLoad(load, {}).u;
  }
  [[nodiscard]] Eigen::VectorXd linear(std::size_t position, const Vec3& f) const {
    const double tiny = 1e-7;
    return newton(position, tiny * f) / tiny;
  }

  /// Largest error of the model's field over the largest displacement, the load given.
  [[nodiscard]] double fieldError(const MetaModel& model, std::size_t position, const Vec3& parameter,
                                  const Eigen::VectorXd& truth) const {
    FieldScratch scratch(model);
    std::vector<float> u(3 * setup_->surface.nodes.size());
    const FieldSource source{touch(position), parameter, 1.0};
    evaluateField(model, std::span(&source, 1), scratch, u);
    double largest = 0.0;
    for (std::size_t i = 0; i < setup_->surface.nodes.size(); ++i)
      largest = std::max(largest, (Eigen::Map<const Eigen::Vector3f>(u.data() + 3 * i).cast<double>() -
                                   truth.segment<3>(3 * setup_->surface.nodes[i]))
                                      .norm());
    return largest / truth.cwiseAbs().maxCoeff();
  }

  mesh::TetMesh organ_;
  Case c_;
  std::unique_ptr<SolverSetup> setup_;
  const palpate::testing::TemporaryFile file_{"load_driven.h5"};
};

TEST_F(Block, ForceSeriesFindsTheForceOfAnImposedDisplacement) {
  c_.method = Method::kSeriesForce;
  const MetaModel model = solve();
  EXPECT_EQ(model.attributes().parameters, Parameters::kForce);
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  for (std::size_t position = 0; position < accessible(); position += 9) {
    const Vec3 direction = Vec3(normal(random), normal(random), normal(random)).normalized();
    Response response;
    ASSERT_NE(respond(model, touch(position), 1e-6 * direction, response), ResponseStatus::kNoAnswer);
    const Vec3 d = 0.6 * response.domain_radius * direction;
    ASSERT_EQ(respond(model, touch(position), d, response), ResponseStatus::kOk);
    const NewtonResult truth =
        NewtonSolver(setup_->model).solvePatch(setup_->positions.patches[position], d, {});
    EXPECT_LT((response.force - truth.force).norm(), 0.03 * truth.force.norm());
    EXPECT_LT(fieldError(model, position, response.parameter, truth.u), 0.03);
  }
}

TEST_F(Block, ContactDisplacementOfAForceSeriesIsWithinItsTolerance) {
  c_.method = Method::kSeriesForce;
  const MetaModel model = solve();
  for (std::size_t position = 0; position < accessible(); position += 9) {
    const Vec3 f = model.view().contact_domain_radius[position] * Vec3(-0.48, 0.6, -0.64);
    Response response;
    ASSERT_EQ(respondToLoad(model, touch(position), 0.999 * f, response), ResponseStatus::kOk);
    const Vec3 d = setup_->positions.patches[position].average(newton(position, 0.999 * f));
    EXPECT_LT((response.displacement - d).norm(), 0.012 * d.norm());
  }
}

TEST_F(Block, ErrorOfAForceSeriesFallsAsModesAreAdded) {
  c_.method = Method::kSeriesForce;
  double before = 1.0;
  for (const int modes : {6, 24, 96}) {
    c_.modes = modes;
    BuildReport report;
    (void)solve(report);
    EXPECT_LT(report.fit_errors.back(), 0.6 * before) << modes;
    before = report.fit_errors.back();
  }
}

constexpr double kRounding = 6e-5;  // of the largest displacement; the model's field is rounded to 16 bits

TEST_F(Block, LinearPgdIsTheLinearSolutionAtEveryLevel) {
  c_.method = Method::kPgdLinear;
  c_.pgd.tolerance = 1e-9;
  c_.load.direction = Vec3(0.6, 0.0, -0.8);
  c_.load.magnitude = 3.0;
  const MetaModel model = solve();
  EXPECT_EQ(model.attributes().parameters, Parameters::kLevel);
  EXPECT_EQ(model.attributes().load, 3.0);
  for (std::size_t position = 0; position < accessible(); position += 11) {
    const Eigen::VectorXd truth = linear(position, 3.0 * Vec3(0.6, 0.0, -0.8));
    for (const double t : {0.25, 1.0})
      EXPECT_LT(fieldError(model, position, Vec3(t, 0.0, 0.0), t * truth), kRounding);
    Response response;
    ASSERT_EQ(respondToLoad(model, touch(position), Vec3(0.5, 0.0, 0.0), response), ResponseStatus::kOk);
    EXPECT_LT((response.displacement - 0.5 * setup_->positions.patches[position].average(truth)).norm(),
              1e-5 * truth.cwiseAbs().maxCoeff());
  }
}

TEST_F(Block, LinearPgdOfAnyDirectionHasTheComplianceOfThePatch) {
  c_.method = Method::kPgdLinear;
  c_.pgd.tolerance = 1e-9;
  c_.load.any_direction = true;
  const MetaModel model = solve();
  EXPECT_EQ(model.attributes().parameters, Parameters::kForce);
  EXPECT_EQ(model.attributes().order, 1);
  const Vec3 f = model.attributes().reference_force * Vec3(0.3, 0.5, -0.6);
  for (std::size_t position = 0; position < accessible(); position += 11) {
    const Eigen::VectorXd truth = linear(position, f);
    EXPECT_LT(fieldError(model, position, f, truth), kRounding);
    Response response;
    ASSERT_EQ(respond(model, touch(position), setup_->positions.patches[position].average(truth), response),
              ResponseStatus::kOk);
    EXPECT_LT((response.force - f).norm(), 1e-4 * f.norm());
  }
}

TEST_F(Block, HadamardPairsAndTruncatedLoadsComeToTheSame) {
  c_.method = Method::kPgdLinear;
  c_.pgd.hadamard = true;
  c_.pgd.tolerance = 1e-3;
  c_.load.truncation = 60;
  c_.modes = 300;
  const MetaModel model = solve();
  const Vec3 f = model.attributes().load * Vec3(0.0, 0.0, -1.0);
  for (std::size_t position = 0; position < accessible(); position += 17)
    EXPECT_LT(fieldError(model, position, Vec3(1.0, 0.0, 0.0), linear(position, f)), 0.05);
}

TEST_F(Block, MedianContactMovesTwoMillimetresUnderTheLoadThatIsChosen) {
  c_.method = Method::kPgdLinear;
  const MetaModel model = solve();
  std::vector<double> travel;
  for (std::size_t position = 0; position < accessible(); ++position) {
    Response response;
    (void)respondToLoad(model, touch(position), Vec3(1.0, 0.0, 0.0), response);
    travel.push_back(-response.displacement.z());
  }
  std::nth_element(travel.begin(), travel.begin() + static_cast<std::ptrdiff_t>(travel.size() / 2),
                   travel.end());
  EXPECT_NEAR(travel[travel.size() / 2], 2e-3, 0.4e-3);
}

TEST_F(Block, NodalLoadsMoveTheNode) {
  c_.method = Method::kPgdLinear;
  c_.pgd.tolerance = 1e-9;
  c_.load.node = true;
  const MetaModel model = solve();
  for (std::size_t position = 0; position < accessible(); position += 11) {
    ASSERT_EQ(setup_->positions.patches[position].nodes.size(), 1U);
    const Eigen::VectorXd truth = linear(position, model.attributes().load * Vec3(0.0, 0.0, -1.0));
    Response response;
    ASSERT_EQ(respondToLoad(model, touch(position), Vec3(1.0, 0.0, 0.0), response), ResponseStatus::kOk);
    const Vec3 moved = truth.segment<3>(3 * setup_->positions.patches[position].nodes[0]);
    EXPECT_LT((response.displacement - moved).norm(), 1e-4 * moved.norm());
  }
}

/// Largest error of the contact displacement against Newton over some positions, at levels where the model is
/// trusted.
double contactError(const MetaModel& model, const SolverSetup& setup,
                    const std::vector<std::size_t>& positions, double level) {
  const auto& a = model.attributes();
  double worst = 0.0;
  for (const std::size_t position : positions) {
    const double t = std::min(level, model.view().contact_domain_radius[position]);
    const ContactPoint s = setup.surface.atNode(setup.positions.nodes[position]);
    ContactPoint contact;
    contact.triangle = s.triangle;
    contact.barycentric = s.barycentric;
    Response response;
    EXPECT_EQ(respondToLoad(model, contact, Vec3(t, 0.0, 0.0), response), ResponseStatus::kOk);
    Eigen::VectorXd load = Eigen::VectorXd::Zero(3 * setup.model.nodeCount());
    setup.positions.patches[position].addForce(t * a.load * Eigen::Map<const Vec3>(a.load_direction.data()),
                                               load);
    const Vec3 d = setup.positions.patches[position].average(NewtonSolver(setup.model).solveLoad(load, {}).u);
    worst = std::max(worst, (response.displacement - d).norm() / d.norm());
  }
  return worst;
}

TEST_F(Block, LoadSteppingFollowsNewtonAndForwardEulerFallsBehind) {
  c_.load.direction = Vec3(0.0, 0.6, -0.8);
  c_.load.steps = 10;
  c_.pgd.tolerance = 1e-3;
  std::array<double, 2> half{}, full{};
  for (std::size_t i = 0; i < 2; ++i) {
    c_.method = i == 0 ? Method::kPgdExplicit : Method::kPgdEuler;
    const MetaModel model = solve();
    EXPECT_EQ(model.attributes().parameters, Parameters::kLevel);
    half[i] = contactError(model, *setup_, {0, 20, 40}, 0.5);
    full[i] = contactError(model, *setup_, {0, 20, 40}, 1.0);
  }
  EXPECT_LT(half[0], 5e-3);
  EXPECT_LT(full[0], 5e-3);
  EXPECT_GT(full[1], 2.0 * full[0]);
}

TEST_F(Block, LoadSteppingThatCannotFitTheMemoryIsRefusedBeforeItBegins) {
  c_.method = Method::kPgdExplicit;
  c_.load.steps = 100000;
  c_.modes = 300;
  organ_ = mesh::makeBox(Vec3(0.06, 0.05, 0.04), {15, 14, 13});
  for (std::int32_t node = 0; node < static_cast<std::int32_t>(organ_.nodes.size()); ++node) {
    const bool held = organ_.nodes[static_cast<std::size_t>(node)].x() < 1e-9;
    organ_.groups[held ? "fixed" : "accessible"].push_back(node);
  }
  BuildReport report;
  try {
    (void)buildModel(c_, organ_, {2, std::filesystem::temp_directory_path(), true}, report);
    FAIL() << "terabytes were begun with";
  } catch (const CaseError& error) {
    EXPECT_NE(std::string(error.what()).find("load.steps"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace palpate::solver
