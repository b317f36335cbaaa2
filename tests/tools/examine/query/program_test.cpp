// SPDX-License-Identifier: Apache-2.0
// palpate-query as its user sees it: exit code, standard output, standard error.
#include <algorithm>
#include <array>
#include <fstream>

#include "palpate/testing/xml_fault.h"
#include "parsed_deck.h"
#include "query_program.h"
#include "tools/examine/query/together.h"

namespace palpate::query::test {
namespace {

TEST(Program, AnswersInJson) {
  const BoxModel box;
  const std::int64_t node = BoxMesh::number(4, 2, 2);
  const ProgramResult result =
      query(box, {"--node", std::to_string(node), "--displacement", "-0.001,0,-.002", "--json"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_TRUE(result.err.empty()) << result.err;
  const auto json = nlohmann::json::parse(result.out);
  const Vec3 d(-0.001, 0.0, -0.002);
  const Anchor anchor = anchorAtNode(box.model, node);
  const Answer answer = ask(box.model, anchor, d);
  EXPECT_EQ(vectorOf(json.at("force")), answer.response.force);
  for (int row = 0; row < 3; ++row)
    EXPECT_EQ(vectorOf(json.at("stiffness").at(static_cast<std::size_t>(row))),
              Vec3(answer.response.stiffness.row(row)));
  EXPECT_EQ(vectorOf(json.at("displacement")), d);
  EXPECT_EQ(json.at("anchor").at("node"), node);
  EXPECT_EQ(json.at("anchor").at("triangle"), anchor.s.triangle);
  EXPECT_EQ(json.at("anchor").at("barycentric").get<std::vector<double>>(),
            std::vector<double>(anchor.s.barycentric.begin(), anchor.s.barycentric.end()));
  EXPECT_EQ(vectorOf(json.at("anchor").at("position")), anchor.position);
  EXPECT_EQ(json.at("domain_radius"), answer.response.domain_radius);
  EXPECT_EQ(json.at("status"), "ok");
  EXPECT_FALSE(json.contains("newton"));
}

TEST(Program, ComparesWithNewtonAndWritesFiles) {
  const BoxModel box;
  const auto deck = box.folder / "deck.inp", field = box.folder / "field.vtu";
  const ProgramResult result =
      query(box, {"--at", "0.083,0.031,0.045", "--displacement=0,0,-0.002", "--ccx", deck.string(), "--field",
                  field.string(), "--steps", "2", "--json"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const Vec3 d(0.0, 0.0, -0.002);
  const Anchor anchor = anchorNear(box.model, {0.083, 0.031, 0.045});
  const FullSolution truth = box.solve(anchor, d);
  const Errors errors = errorsOf(ask(box.model, anchor, d), truth, box.organ);
  const auto newton = nlohmann::json::parse(result.out).at("newton");
  EXPECT_LT((vectorOf(newton.at("force")) - truth.state.force).norm(), 1e-7 * truth.state.force.norm());
  EXPECT_NEAR(newton.at("force_error"), errors.force, 1e-6);
  EXPECT_NEAR(newton.at("field_error_max"), errors.field_max, 1e-6);
  EXPECT_NEAR(newton.at("field_error_l2"), errors.field_l2, 1e-6);
  EXPECT_NEAR(newton.at("min_det_f"), truth.min_det_f, 1e-7);
  EXPECT_LT((vectorOf(newton.at("anchor_displacement")) - truth.displacement(box.organ, anchor.node)).norm(),
            1e-9);
  EXPECT_EQ(ParsedDeck(contentOf(deck)).under.at("*NODE,NSET=ALL").size(), 72U);
  EXPECT_EQ(testing::xmlFault(contentOf(field)), "");
  EXPECT_NE(contentOf(field).find("Name=\"error\""), std::string::npos);
}

TEST(Program, TellsAPersonTheSame) {
  const BoxModel box;
  const ProgramResult result =
      query(box, {"--at", "0.083,0.031,0.045", "--displacement", "0,0,-0.002", "--newton"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  for (const char* part :
       {"anchor", "status", "domain radius", "force on organ", "stiffness", "Newton: force", "min det F"})
    EXPECT_NE(result.out.find(part), std::string::npos) << part;
}

TEST(Program, AnswersAForceAndChecksItByNewton) {
  const LoadModel box(Parameters::kForce);
  const auto deck = box.folder / "deck.inp";
  const std::string node = std::to_string(BoxMesh::number(4, 2, 2));
  const ProgramResult result =
      query(box, {"--node", node, "--force", "-.02,0.01,-0.04", "--ccx", deck.string(), "--json"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const auto json = nlohmann::json::parse(result.out);
  const Vec3 f(-0.02, 0.01, -0.04);
  EXPECT_EQ(json.at("parameters"), "force");
  EXPECT_EQ(json.at("status"), "ok");
  EXPECT_EQ(vectorOf(json.at("force")), f);
  EXPECT_FALSE(json.contains("load_level"));
  const auto newton = json.at("newton");
  EXPECT_EQ(vectorOf(newton.at("force")), f);
  const Vec3 d = vectorOf(json.at("displacement")), full = vectorOf(newton.at("displacement"));
  EXPECT_NEAR(newton.at("displacement_error"), (d - full).norm() / full.norm(), 1e-12);
  EXPECT_LT(newton.at("displacement_error"), 0.01);
  EXPECT_LT(newton.at("field_error_max"), 0.02);
  EXPECT_LT(newton.at("field_error_l2"), 0.01);
  EXPECT_GT(newton.at("min_det_f"), 0.0);
  EXPECT_EQ(vectorOf(newton.at("anchor_displacement")).size(), 3);
  EXPECT_FALSE(newton.contains("force_error"));
  EXPECT_NE(contentOf(deck).find("force -.02,0.01,-0.04 N"), std::string::npos);
  const auto far = nlohmann::json::parse(query(box, {"--node", node, "--force", "0,0,-99", "--json"}).out);
  EXPECT_EQ(far.at("status"), "beyond_domain");
  const std::string told = query(box, {"--node", node, "--force", "0,0,-99"}).out;
  EXPECT_NE(told.find("beyond_domain: asked for 99 N"), std::string::npos) << told;
}

TEST(Program, ForceModelAnswersAnImposedDisplacement) {
  const LoadModel box(Parameters::kForce);
  const std::string node = std::to_string(BoxMesh::number(4, 2, 2));
  const ProgramResult result =
      query(box, {"--node", node, "--displacement", "0,0,-0.001", "--newton", "--json"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const auto json = nlohmann::json::parse(result.out);
  EXPECT_LT((vectorOf(json.at("displacement")) - Vec3(0.0, 0.0, -0.001)).norm(), 1e-11);
  EXPECT_LT(json.at("newton").at("force_error"), 0.01);
  EXPECT_FALSE(json.at("newton").contains("displacement_error"));
}

TEST(Program, AnswersALoadLevel) {
  const LoadModel box(Parameters::kLevel);
  const std::string node = std::to_string(BoxMesh::number(4, 2, 2));
  const ProgramResult result = query(box, {"--node", node, "--load-level", "0.1", "--newton", "--json"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const auto json = nlohmann::json::parse(result.out);
  EXPECT_EQ(json.at("parameters"), "level");
  EXPECT_EQ(json.at("load_level"), 0.1);
  const Vec3 load = 0.1 * LoadModel::kLoad * LoadModel::direction();
  EXPECT_LT((vectorOf(json.at("force")) - load).norm(), 1e-15);
  EXPECT_LT((vectorOf(json.at("newton").at("force")) - load).norm(), 1e-15);
  EXPECT_LT(json.at("newton").at("displacement_error"), 0.01);
  const std::string told = query(box, {"--node", node, "--load-level", "0.1", "--newton"}).out;
  EXPECT_NE(told.find("load level"), std::string::npos) << told;
  EXPECT_NE(told.find("model is off"), std::string::npos) << told;
}

TEST(Program, AnswersTwoToolsAndChecksThemByNewton) {
  const BoxModel box;
  const auto field = box.folder / "field.vtu";
  const std::int64_t first = BoxMesh::number(3, 1, 2), second = BoxMesh::number(5, 1, 2);
  const ProgramResult result =
      query(box, {"--node", std::to_string(first), "--displacement", "0,0,-0.001", "--tool2",
                  std::to_string(second) + ":0,0,-0.0008", "--newton", "--json", "--field", field.string()});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const auto json = nlohmann::json::parse(result.out);
  const auto two = json.at("two_tools");
  const std::array<Touch, 2> touches{Touch{anchorAtNode(box.model, first), Vec3(0.0, 0.0, -0.001)},
                                     Touch{anchorAtNode(box.model, second), Vec3(0.0, 0.0, -0.0008)}};
  const JointAnswer answer = askTogether(box.model, touches);
  const FullSolution truth = solveTogether(box.organ, touches, box.model.attributes().patch_radius, 1);
  const JointErrors errors = coupledErrors(answer, touches, truth, box.organ);
  EXPECT_NEAR(two.at("force1_error"), errors.force[0], 1e-6);
  EXPECT_NEAR(two.at("force2_error"), errors.force[1], 1e-6);
  EXPECT_NEAR(two.at("field_error_max"), errors.field.max, 1e-6);
  EXPECT_NEAR(two.at("field_error_l2"), errors.field.l2, 1e-6);
  EXPECT_LT(two.at("force1_error"), 0.1 * two.at("superposed").at("force1_error").get<double>());
  const Vec3 together = vectorOf(two.at("tools").at(0).at("force")), alone = vectorOf(json.at("force"));
  EXPECT_EQ(vectorOf(two.at("tools").at(0).at("force_alone")), alone);
  EXPECT_NEAR(two.at("coupling_force1_N"), (together - alone).norm(), 1e-12);
  const Vec3 full = vectorOf(two.at("newton").at("forces").at(0)),
             full_alone = vectorOf(json.at("newton").at("force"));
  EXPECT_NEAR(two.at("newton").at("coupling_force1_N"), (full - full_alone).norm(), 1e-9);
  EXPECT_NEAR(two.at("coupling_force1_N"), two.at("newton").at("coupling_force1_N"), 0.05 * full.norm());
  EXPECT_NEAR(two.at("tools").at(1).at("distance_m"), 0.04, 1e-12);
  EXPECT_EQ(two.at("tools").at(1).at("node"), second);
  EXPECT_EQ(testing::xmlFault(contentOf(field)), "");
}

TEST(Program, AnswersThreeToolsToAPerson) {
  const BoxModel box;
  const std::vector<std::string> words{
      "--node",         std::to_string(BoxMesh::number(3, 1, 2)),
      "--displacement", "0,0,-0.001",
      "--tool2",        std::to_string(BoxMesh::number(5, 1, 2)) + ":0,0,-0.0008",
      "--tool2",        std::to_string(BoxMesh::number(4, 3, 1)) + ":0,-0.0005,0"};
  const ProgramResult result = query(box, words);
  ASSERT_EQ(result.exit_code, 0) << result.err;
  for (const char* part : {"together:", "tool 2", "tool 3", "own part", "by the others"})
    EXPECT_NE(result.out.find(part), std::string::npos) << part;
  std::vector<std::string> checked = words;
  checked.emplace_back("--newton");
  const ProgramResult truth = query(box, checked);
  ASSERT_EQ(truth.exit_code, 0) << truth.err;
  for (const char* part : {"Newton: force3", "superposed", "model is off"})
    EXPECT_NE(truth.out.find(part), std::string::npos) << part << truth.out;
}

TEST(Program, SaysWhenAPointIsNotAccessible) {
  const BoxModel box;
  const ProgramResult result =
      query(box, {"--at", "-0.01,0.03,0.02", "--displacement", "0.001,0,0", "--json"});
  EXPECT_EQ(result.exit_code, 0);
  const auto json = nlohmann::json::parse(result.out);
  EXPECT_EQ(json.at("status"), "not_accessible");
  EXPECT_EQ(vectorOf(json.at("force")), Vec3(Vec3::Zero()));
  EXPECT_NE(result.err.find("not accessible"), std::string::npos) << result.err;
  expectOneLineError(query(box, {"--at", "-0.01,0.03,0.02", "--displacement", "0.001,0,0", "--newton"}),
                     "clamped nodes only");
}

TEST(Program, AnswersATableOfTouches) {
  const BoxModel box;
  const std::string titles = "at_x,at_y,at_z,displacement_x,displacement_y,displacement_z\n";
  const auto touches = box.folder.write("touches.csv", titles + "83,31,41,0,0,-2\n60,20,40,0.5,0,-1\n");
  const std::string answers = box.folder / "answers.csv";
  const ProgramResult result = query(box, {"--batch", touches.string(), "--unit", "mm", "-o", answers});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const std::string written = contentOf(answers);
  EXPECT_EQ(query(box, {"--batch", touches.string(), "--unit", "mm"}).out, written);
  EXPECT_EQ(std::count(written.begin(), written.end(), '\n'), 3);
  EXPECT_NE(written.find("\n60,20,40,0.5,0,-1,"), std::string::npos) << written;
  box.folder.write("touches.csv", titles + "83,31,41,0,0,-2\n60,20,x,0.5,0,-1\n");
  expectOneLineError(query(box, {"--batch", touches.string(), "--unit", "mm", "-o", answers}),
                     "touches.csv, line 3, column at_z: 'x' is not a finite number");
  box.folder.write("touches.csv", titles + "83,31,941,0,0,-2\n");
  const ProgramResult off = query(box, {"--batch", touches.string(), "--unit", "mm", "-o", answers});
  EXPECT_EQ(off.exit_code, 1);  // the file's fault
  expectOneLineError(off, "touches.csv, line 2, at 83,31,941 mm lies 901 mm from the organ's surface");
  EXPECT_EQ(contentOf(answers), written);  // as it was
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(box.folder.path()), {}),
            3);  // nothing half written
}

TEST(Program, WarnsOfElementsTurnedInsideOut) {
  const BoxModel box;
  const ProgramResult result = query(
      box, {"--node", std::to_string(BoxMesh::number(5, 3, 2)), "--displacement", "-0.09,0,0", "--newton"});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_NE(result.err.find("inside out (min det F -"), std::string::npos) << result.err;
  EXPECT_NE(result.out.find("beyond_domain"), std::string::npos) << result.out;
}

}  // namespace
}  // namespace palpate::query::test
