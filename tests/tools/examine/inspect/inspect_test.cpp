// SPDX-License-Identifier: Apache-2.0
// palpate-inspect as its own process.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "palpate/testing/run_program.h"
#include "palpate/testing/synthetic_model.h"
#include "tools/modelfile/write_model.h"

namespace palpate::testing {

namespace {

using ::testing::HasSubstr;

ProgramResult inspect(const std::vector<std::string>& arguments) {
  return runProgram("palpate-inspect", arguments);
}

}  // namespace

TEST(Inspect, JsonHoldsWhatTheFileHolds) {
  const TemporaryFile file("inspect.h5");
  writeSyntheticModel(file.path(), {.subdivisions = 2, .modes = 4});
  const ProgramResult run = inspect({"--json", file.path().string()});
  ASSERT_EQ(run.exit_code, 0);
  const auto json = nlohmann::json::parse(run.out);
  EXPECT_EQ(json["digest"]["sha256"].get<std::string>().substr(0, 40), json["model_id"].get<std::string>());
  EXPECT_TRUE(json["digest"]["verified"]);
  EXPECT_EQ(json["parameters"], "displacement");
  EXPECT_EQ(json["nodes"], 163);
  EXPECT_EQ(json["tetrahedra"], 320);
  EXPECT_EQ(json["surface_nodes"], 162);
  EXPECT_LT(json["accessible_nodes"], json["contact_positions"]);
  EXPECT_EQ(json["modes"], 4);
  EXPECT_EQ(json["order"], 3);
  EXPECT_EQ(json["coefficients"], 19);
  EXPECT_DOUBLE_EQ(json["near_radius"], 0.02);
  EXPECT_DOUBLE_EQ(json["patch_radius"], 0.008);
  EXPECT_EQ(json["file_bytes"], std::filesystem::file_size(file.path()));
  EXPECT_EQ(json["material"]["law"], "stvk");
  EXPECT_DOUBLE_EQ(json["material"]["E"], 160e3);
  EXPECT_DOUBLE_EQ(json["material"]["nu"], 0.48);
  EXPECT_EQ(json["provenance"]["program"], "synthetic");
  EXPECT_DOUBLE_EQ(json["domain_radius"]["p05"], 0.008);
  EXPECT_EQ(json["reach"][0]["travel"], 0.007);
  EXPECT_EQ(json["reach"][0]["by_domain_radius"], 1.0);
  EXPECT_EQ(json["reach"][1]["by_domain_radius"], 0.0);
  EXPECT_EQ(json["element_order"], 1);
  const unsigned rows = json["contact_positions"].get<unsigned>() * (19U - 3U);
  EXPECT_EQ(json["bytes"]["far_field"], 2U * (4U * 3U * 162U + rows * 4U) + 4U * (4U + rows));
  EXPECT_GT(json["bytes"]["greens_functions"], 2U * 3U * 4U * json["contact_positions"].get<unsigned>());
}

TEST(Inspect, SaysWhichRegionsAndSpringsThereAre) {
  const TemporaryFile file("inspect-regions.h5");
  modelfile::ModelData data = syntheticModel({.subdivisions = 1});
  data.mesh_element_region.assign(data.mesh_tetrahedron_tag.size(), 0);
  data.mesh_element_region.front() = 1;
  data.region_name = {regionName("elsewhere"), regionName("nodule")};
  data.region_E = {5e3, 70e3};
  data.region_nu = {0.48, 0.3};
  data.region_law = {regionName("stable-neo-hookean"), regionName("stvk")};
  data.spring_node = {1, 3};
  data.spring_stiffness = {2.0, 3.0};
  modelfile::writeModel(file.path(), data);
  const auto json = nlohmann::json::parse(inspect({"--json", file.path().string()}).out);
  EXPECT_EQ(json["regions"]["nodule"],
            (nlohmann::json{{"law", "stvk"}, {"E", 70e3}, {"nu", 0.3}, {"tetrahedra", 1}}));
  EXPECT_EQ(json["regions"]["elsewhere"]["tetrahedra"], data.mesh_tetrahedron_tag.size() - 1);
  EXPECT_EQ(json["springs"], (nlohmann::json{{"nodes", 2}, {"stiffness", 5.0}}));
  const ProgramResult run = inspect({file.path().string()});
  EXPECT_THAT(run.out, HasSubstr("regions.nodule            {\"law\":\"stvk\",\"E\":70000"));
}

TEST(Inspect, DoesNotDescribeAModelThatWasChanged) {
  const TemporaryFile file("inspect-changed.h5");
  modelfile::ModelData data = syntheticModel({.subdivisions = 1});
  data.attributes.E = 123456.75;
  modelfile::writeModel(file.path(), data);
  std::string bytes = contentOf(file.path());
  const auto number = [](double x) { return std::string(reinterpret_cast<const char*>(&x), sizeof x); };
  bytes.replace(bytes.find(number(123456.75)), sizeof(double), number(123456.5));
  std::ofstream(file.path(), std::ios::binary) << bytes;
  const ProgramResult run = inspect({"--json", file.path().string()});
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_EQ(run.out, "");
  EXPECT_THAT(run.err, HasSubstr("the digest of its content is"));
}

TEST(Inspect, TellsWhatAForceModelIsTrustedFor) {
  const TemporaryFile file("inspect-force.h5");
  writeSyntheticModel(file.path(), {.subdivisions = 1, .parameters = Parameters::kForce});
  const auto json = nlohmann::json::parse(inspect({"--json", file.path().string()}).out);
  EXPECT_EQ(json["parameters"], "force");
  EXPECT_EQ(json["order"], 3);
  EXPECT_DOUBLE_EQ(json["reference_force"], 0.8);
  for (const char* quantile : {"min", "p05", "median", "max"})
    EXPECT_DOUBLE_EQ(json["force_radius"][quantile], 1.2);
  EXPECT_TRUE(json["domain_radius"].is_null());
  EXPECT_FALSE(json.contains("load"));
}

TEST(Inspect, TellsTheLoadOfALevelModel) {
  const TemporaryFile file("inspect-level.h5");
  writeSyntheticModel(file.path(), {.subdivisions = 1, .parameters = Parameters::kLevel});
  const auto json = nlohmann::json::parse(inspect({"--json", file.path().string()}).out);
  EXPECT_EQ(json["parameters"], "level");
  EXPECT_DOUBLE_EQ(json["load"]["size"], 1.5);
  EXPECT_EQ(json["load"]["direction"], nlohmann::json({0.0, 0.6, -0.8}));
  EXPECT_EQ(json["load"]["level_functions"], 3);
  EXPECT_EQ(json["load"]["level_steps"], 10);
  EXPECT_EQ(json["coefficients"], 3);
  EXPECT_DOUBLE_EQ(json["level_radius"]["median"], 0.85);
  EXPECT_TRUE(json["order"].is_null());
  const ProgramResult table = inspect({file.path().string()});
  EXPECT_THAT(table.out, HasSubstr("parameters                level\n"));
  EXPECT_THAT(table.out, HasSubstr("load.direction            [0.0,0.6,-0.8]\n"));
}

TEST(Inspect, TableIsForPeople) {
  const TemporaryFile file("inspect-table.h5");
  writeSyntheticModel(file.path(), {.subdivisions = 1});
  const ProgramResult run = inspect({file.path().string()});
  EXPECT_EQ(run.exit_code, 0);
  EXPECT_THAT(run.out, HasSubstr("surface_nodes             42\n"));
  EXPECT_THAT(run.out, HasSubstr("material.law              stvk\n"));
  EXPECT_THAT(run.out,
              HasSubstr("reach.7_mm                100.0 % of the surface by domain_radius, 100.0 % by "
                        "series_radius\n"));
}

TEST(Inspect, ControlCharactersOfAFileDoNotReachTheTerminal) {
  const TemporaryFile file("inspect-control.h5");
  modelfile::ModelData data = syntheticModel({.subdivisions = 1});
  data.attributes.certificate = R"({"note\u001b[2J": "a\u0007b\u009bc\u00e4\r", "list": ["\u001b"]})";
  modelfile::writeModel(file.path(), data);
  const ProgramResult run = inspect({file.path().string()});
  EXPECT_EQ(run.exit_code, 0);
  EXPECT_THAT(run.out, HasSubstr("certificate.note\\x1b[2J   a\\x07b\\xc2\\x9bc\u00e4\\x0d\n"));
  for (const char control : {'\x1b', '\a', '\r', '\x9b'})
    EXPECT_EQ(run.out.find(control), std::string::npos) << static_cast<int>(control);
}

TEST(Inspect, TruncatedModelGivesOneClearLineAndFails) {
  const TemporaryFile file("inspect-truncated.h5");
  writeSyntheticModel(file.path(), {.subdivisions = 1});
  std::filesystem::resize_file(file.path(), 5000);
  expectOneLineError(inspect({"--json", file.path().string()}),
                     "palpate-inspect: " + file.path().string() + ": HDF5 cannot open its 5000 bytes");
}

TEST(Inspect, NeedsAModel) {
  EXPECT_NE(inspect({}).exit_code, 0);
  EXPECT_EQ(inspect({"--help"}).exit_code, 0);
}

}  // namespace palpate::testing
