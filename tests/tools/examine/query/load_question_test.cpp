// SPDX-License-Identifier: Apache-2.0
// Questions to load-driven models: a force, a load level, a displacement.
#include <gtest/gtest.h>

#include "load_models.h"

namespace palpate::query::test {
namespace {

/// A load-driven model of the box, loaded, and its full problem.
struct Loaded {
  explicit Loaded(Parameters parameters, double patch_radius = 0.012)
      : file(parameters, patch_radius),
        model(MetaModel::load(file.path)),
        organ(organOf(model, modelfile::readVolumeMesh(file.path))) {}

  [[nodiscard]] FullSolution solve(const Anchor& anchor, const Question& question) const {
    return solveUnderLoad(organ, anchor, model.attributes().patch_radius, forceOf(model, question), 1);
  }
  [[nodiscard]] Errors errors(const Anchor& anchor, const Question& question) const {
    return errorsOf(ask(model, anchor, question), solve(anchor, question), organ);
  }

  LoadModel file;
  MetaModel model;
  Organ organ;
};

Question force(const Vec3& f) {
  return {Parameters::kForce, f};
}

Question level(double t) {
  return {Parameters::kLevel, {t, 0.0, 0.0}};
}

}  // namespace

TEST(LoadQuestion, ForceModelAgreesWithNewtonToItsOrder) {
  const Loaded box(Parameters::kForce);
  const Anchor anchor = anchorAtNode(box.model, BoxMesh::number(4, 2, 2));
  const Vec3 f(1.5, 0.75, -3.0);  // so that the series' error is well above the rounding of the field
  const Errors large = box.errors(anchor, force(f)), small = box.errors(anchor, force(0.5 * f));
  EXPECT_LT(large.displacement, 1e-2);
  // Relative errors of a series of degree 3 are of degree 3.
  EXPECT_GT(large.displacement, 6.0 * small.displacement);
  EXPECT_GT(large.field_max, 6.0 * small.field_max);
  EXPECT_EQ(ask(box.model, anchor, force(f)).status, ResponseStatus::kOk);
}

TEST(LoadQuestion, LevelModelIsTheForceModelInOneDirection) {
  const Loaded by_force(Parameters::kForce), by_level(Parameters::kLevel);
  const Anchor anchor = anchorNear(by_force.model, {0.083, 0.031, 0.06});
  const Answer one = ask(by_level.model, anchor, level(0.1));
  const Answer other = ask(by_force.model, anchor, force(0.1 * LoadModel::kLoad * LoadModel::direction()));
  EXPECT_LT((one.response.force - other.response.force).norm(), 1e-15);
  EXPECT_LT((one.response.displacement - other.response.displacement).norm(),
            1e-3 * one.response.displacement.norm());
  for (std::size_t i = 0; i < one.field.size(); ++i) EXPECT_NEAR(one.field[i], other.field[i], 1e-6);
}

TEST(LoadQuestion, FieldUnderAForceAveragesToItsDisplacement) {
  const Loaded box(Parameters::kForce);
  const Anchor anchor = anchorAtNode(box.model, BoxMesh::number(4, 1, 2));
  const Answer answer = ask(box.model, anchor, force({0.01, -0.01, -0.03}));
  const solver::Patch patch = box.solve(anchor, force({0.0, 0.0, -0.001})).patch;
  Eigen::VectorXd u = Eigen::VectorXd::Zero(3 * box.organ.body.nodeCount());
  for (std::size_t i = 0; i < box.organ.surface.nodes.size(); ++i)
    for (int axis = 0; axis < 3; ++axis)
      u[3 * box.organ.surface.nodes[i] + axis] =
          static_cast<double>(answer.field[3 * i + static_cast<std::size_t>(axis)]);
  EXPECT_LT((patch.average(u) - answer.response.displacement).norm(), 1e-8);
}

TEST(LoadQuestion, BeyondTheDomainIsTheClampedOne) {
  const Loaded box(Parameters::kForce);
  const Anchor anchor = anchorAtNode(box.model, BoxMesh::number(4, 2, 2));
  const Answer answer = ask(box.model, anchor, force({0.0, 0.0, -50.0}));
  EXPECT_EQ(answer.status, ResponseStatus::kBeyond);
  const auto position =
      static_cast<std::size_t>(box.model.view().position_of_node[static_cast<std::size_t>(anchor.node)]);
  EXPECT_NEAR(answer.response.force.norm(), box.model.view().contact_domain_radius[position], 1e-12);
  EXPECT_NEAR(answer.response.domain_radius, answer.response.displacement.norm(), 1e-12);
}

TEST(LoadQuestion, ADisplacementIsAnsweredByEveryKind) {
  for (const Parameters kind : {Parameters::kForce, Parameters::kLevel}) {
    const Loaded box(kind);
    const Anchor anchor = anchorAtNode(box.model, BoxMesh::number(4, 2, 2));
    const Vec3 d = 0.001 * LoadModel::direction();
    EXPECT_NO_THROW(checkQuestion(box.model, {Parameters::kDisplacement, d}));
    const Answer answer = ask(box.model, anchor, d);
    EXPECT_EQ(answer.status, ResponseStatus::kOk);
    EXPECT_GT(answer.response.force.dot(LoadModel::direction()), 0.0);
  }
}

TEST(LoadQuestion, NodalLoadsAreCheckedAtNodesAndBetweenThem) {
  const Loaded box(Parameters::kLevel, 1e-12);
  const Anchor node = anchorAtNode(box.model, BoxMesh::number(4, 2, 2));
  const FullSolution at_node = box.solve(node, level(0.05));
  ASSERT_EQ(at_node.patch.nodes.size(), 1U);
  EXPECT_EQ(at_node.patch.nodes[0], box.organ.surface.nodes[static_cast<std::size_t>(node.node)]);
  EXPECT_EQ(at_node.d, at_node.displacement(box.organ, node.node));
  EXPECT_LT(box.errors(node, level(0.05)).displacement, 0.01);
  const Anchor between = anchorNear(box.model, {0.073, 0.031, 0.06});
  const FullSolution spread = box.solve(between, level(0.05));
  ASSERT_EQ(spread.patch.nodes.size(), 3U);
  Vec3 centre = Vec3::Zero();
  for (std::size_t i = 0; i < 3; ++i)
    centre +=
        spread.patch.weights[i] * box.organ.body.nodes()[static_cast<std::size_t>(spread.patch.nodes[i])];
  EXPECT_LT((centre - between.position).norm(), 1e-15);
}

TEST(LoadQuestion, NewtonUnderALoadIsInBalanceWithIt) {
  const Loaded box(Parameters::kForce);
  const Anchor anchor = anchorAtNode(box.model, BoxMesh::number(4, 2, 2));
  const Vec3 f(0.0, 0.05, -0.1);
  const FullSolution under_load = box.solve(anchor, force(f));
  const FullSolution imposed =
      solveFully(box.organ, anchor, box.model.attributes().patch_radius, under_load.d, 1);
  EXPECT_LT((imposed.state.force - f).norm(), 1e-6 * f.norm());
  EXPECT_EQ(under_load.state.force, f);
}

TEST(LoadQuestion, ThatTheModelCannotAnswerNamesItsKindAndWhatToUse) {
  const Loaded by_force(Parameters::kForce), by_level(Parameters::kLevel);
  const BoxModel by_displacement;
  const auto complaint = [](const MetaModel& model, const Question& question) {
    return errorOf([&] { checkQuestion(model, question); });
  };
  EXPECT_EQ(complaint(by_displacement.model, force(Vec3::Zero())),
            "--force asks a model driven by force, this one is driven by displacement: use --displacement");
  EXPECT_EQ(complaint(by_level.model, force(Vec3::Zero())),
            "--force asks a model driven by force, this one is driven by level: use --load-level or "
            "--displacement");
  EXPECT_EQ(complaint(by_force.model, level(0.5)),
            "--load-level asks a model driven by level, this one is driven by force: use --force or "
            "--displacement");
  EXPECT_EQ(complaint(by_force.model, force(Vec3::Zero())), "");
}

}  // namespace palpate::query::test
