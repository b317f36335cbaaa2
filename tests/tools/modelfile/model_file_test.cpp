// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>
#include <functional>

#include "core/model/meta_model.h"
#include "palpate/testing/synthetic_model.h"
#include "tools/modelfile/read_volume_mesh.h"
#include "tools/modelfile/write_model.h"
#include "tools/modelfile/write_xdmf.h"

namespace palpate::testing {

namespace {

using modelfile::ModelData;
using modelfile::ModelFileError;
using ::testing::HasSubstr;

std::string complaint(const std::filesystem::path& path, const ModelData& data) {
  try {
    modelfile::writeModel(path, data);
    return {};
  } catch (const ModelFileError& error) {
    return error.what();
  }
}

std::size_t count(const std::string& in, const std::string& what) {
  std::size_t found = 0;
  for (std::size_t at = in.find(what); at != std::string::npos; at = in.find(what, at + 1)) ++found;
  return found;
}

const SyntheticOptions& small() {
  static const SyntheticOptions options{.subdivisions = 1, .modes = 2};
  return options;
}

}  // namespace

TEST(WriteModel, RefusesSizesThatDoNotFit) {
  const std::vector<std::pair<std::string, std::function<void(ModelData&)>>> cases{
      {"order is 0, expected 1 to 7", [](ModelData& d) { d.attributes.order = 0; }},
      {"force_order is 9, expected 1 to 8", [](ModelData& d) { d.attributes.force_order = 9; }},
      {"/surface/mesh_tag is empty", [](ModelData& d) { d.surface_mesh_tag.clear(); }},
      {"/contact/node is empty", [](ModelData& d) { d.contact_node.clear(); }},
      {"/surface/positions has 125 numbers, expected 126",
       [](ModelData& d) { d.surface_positions.pop_back(); }},
      {"/surface/triangles has 239 numbers, expected a multiple of 3",
       [](ModelData& d) { d.surface_triangles.pop_back(); }},
      {"/surface/position_of_node has 41 numbers", [](ModelData& d) { d.position_of_node.pop_back(); }},
      {"/contact/accessible has", [](ModelData& d) { d.contact_accessible.pop_back(); }},
      {"/contact/force has", [](ModelData& d) { d.contact_force.pop_back(); }},
      {"/contact/domain_radius has", [](ModelData& d) { d.contact_domain_radius.push_back(1.0); }},
      {"/contact/series_radius has", [](ModelData& d) { d.contact_series_radius.pop_back(); }},
      {"/modes/X has 251 numbers, expected a multiple of 126", [](ModelData& d) { d.modes_X.pop_back(); }},
      {"/modes/Y has", [](ModelData& d) { d.modes_Y.clear(); }},
      {"/near/offset has", [](ModelData& d) { d.near_offset.pop_back(); }},
      {"/near/field has", [](ModelData& d) { d.near_node.pop_back(); }},
      {"/contact/stiffness has", [](ModelData& d) { d.contact_stiffness.pop_back(); }},
      {"/green/Y has", [](ModelData& d) { d.green_Y.pop_back(); }},
      {"/green/offset has", [](ModelData& d) { d.green_offset.pop_back(); }},
      {"/green/near has", [](ModelData& d) { d.green_near_node.pop_back(); }},
      {"/mesh/nodes has", [](ModelData& d) { d.mesh_node_tag.pop_back(); }},
      {"/mesh/tetrahedra has", [](ModelData& d) { d.mesh_tetrahedra.pop_back(); }},
      {"/mesh/surface_node has", [](ModelData& d) { d.mesh_surface_node.pop_back(); }},
  };
  const TemporaryFile file("sizes.h5");
  for (const auto& [expected, spoil] : cases) {
    ModelData data = syntheticModel(small());
    spoil(data);
    EXPECT_THAT(complaint(file.path(), data), HasSubstr(expected));
    EXPECT_FALSE(std::filesystem::exists(file.path())) << expected;
  }
}

TEST(WriteModel, RefusesLoadDrivenSizesThatDoNotFit) {
  const std::vector<std::tuple<Parameters, std::string, std::function<void(ModelData&)>>> cases{
      {Parameters::kForce, "/contact/displacement has",
       [](ModelData& d) { d.contact_displacement.pop_back(); }},
      {Parameters::kForce, "/contact/force has 3 numbers, expected 0",
       [](ModelData& d) { d.contact_force.assign(3, 0.0); }},
      {Parameters::kForce, "/levels/Z has 2 numbers, expected 0",
       [](ModelData& d) { d.levels_Z.assign(2, 0.0); }},
      {Parameters::kDisplacement, "/contact/displacement has 3 numbers, expected 0",
       [](ModelData& d) { d.contact_displacement.assign(3, 0.0); }},
      {Parameters::kLevel, "/contact/displacement has",
       [](ModelData& d) { d.contact_displacement.pop_back(); }},
      {Parameters::kLevel, "/contact/displacement has 0 level functions, expected 1 to 119",
       [](ModelData& d) { d.contact_displacement.clear(); }},
      {Parameters::kLevel, "/levels/Z has 32 numbers, expected a multiple of 3",
       [](ModelData& d) { d.levels_Z.pop_back(); }},
      {Parameters::kLevel, "/levels/Z has 1 levels, expected at least 2",
       [](ModelData& d) { d.levels_Z.resize(3); }},
      {Parameters::kForce, "/green/node has 1 numbers, expected 0",
       [](ModelData& d) { d.green_node.assign(1, 0); }},
      {Parameters::kLevel, "/green/near has 9 numbers, expected 0",
       [](ModelData& d) { d.green_near.assign(9, 0.0F); }},
      {Parameters::kForce, "/contact/stiffness has 24 numbers, expected 0",
       [](ModelData& d) { d.contact_stiffness.assign(24, 0.0); }},
      {Parameters::kLevel, "/modes/Y has", [](ModelData& d) { d.modes_Y.pop_back(); }},
  };
  const TemporaryFile file("load-driven-sizes.h5");
  for (const auto& [parameters, expected, spoil] : cases) {
    ModelData data = syntheticModel({.subdivisions = 1, .modes = 2, .parameters = parameters});
    spoil(data);
    EXPECT_THAT(complaint(file.path(), data), HasSubstr(expected));
    EXPECT_FALSE(std::filesystem::exists(file.path())) << expected;
  }
}

TEST(WriteXdmf, ShowsTheModesOfALoadDrivenModel) {
  const TemporaryFile model("level.h5"), xdmf("level.xdmf");
  writeSyntheticModel(model.path(), {.subdivisions = 1, .modes = 2, .parameters = Parameters::kLevel});
  modelfile::writeXdmf(model.path());
  EXPECT_EQ(count(contentOf(xdmf.path()), "AttributeType=\"Vector\""), 2U);
  EXPECT_EQ(modelfile::readVolumeMesh(model.path()).node_tag.size(), 43U);
}

TEST(WriteModel, LeavesNothingBehindWhereItCannotWrite) {
  EXPECT_THAT(complaint("/nonexistent/folder/model.h5", syntheticModel(small())), HasSubstr("cannot write"));
  const TemporaryFile folder("folder.h5");
  std::filesystem::create_directory(folder.path());
  EXPECT_NE(complaint(folder.path(), syntheticModel(small())), "") << "the target is a directory";
  EXPECT_FALSE(std::filesystem::exists(folder.path().string() + ".tmp-" + std::to_string(::getpid())));
}

TEST(WriteModel, ReplacesAModelThatIsInUse) {
  const TemporaryFile file("replaced.h5");
  writeSyntheticModel(file.path(), small());
  const MetaModel old = MetaModel::load(file.path());
  writeSyntheticModel(file.path(), {.subdivisions = 2});
  EXPECT_EQ(MetaModel::load(file.path()).surface().nodes(), 162);
  EXPECT_EQ(old.surface().nodes(), 42);
}

TEST(ReadVolumeMesh, GivesTheMeshBack) {
  const TemporaryFile file("mesh.h5");
  const ModelData data = syntheticModel(small());
  modelfile::writeModel(file.path(), data);
  const modelfile::VolumeMesh mesh = modelfile::readVolumeMesh(file.path());
  EXPECT_EQ(mesh.nodes, data.mesh_nodes);
  EXPECT_EQ(mesh.tetrahedra, data.mesh_tetrahedra);
  EXPECT_EQ(mesh.node_tag, data.mesh_node_tag);
  EXPECT_EQ(mesh.tetrahedron_tag, data.mesh_tetrahedron_tag);
  EXPECT_EQ(mesh.fixed, data.mesh_fixed);
  EXPECT_EQ(mesh.surface_node, data.mesh_surface_node);
}

TEST(WriteXdmf, RefersToTheModelsOwnData) {
  const TemporaryFile model("view.h5"), xdmf("view.xdmf");
  writeSyntheticModel(model.path(), small());
  EXPECT_EQ(modelfile::writeXdmf(model.path()), xdmf.path());
  const std::string written = contentOf(xdmf.path());
  const std::string name = model.path().filename().string();
  EXPECT_THAT(written, HasSubstr("Dimensions=\"80 3\" NumberType=\"Int\" Precision=\"4\">" + name +
                                 ":/surface/triangles<"));
  EXPECT_THAT(written, HasSubstr("Dimensions=\"42 3\" NumberType=\"Float\" Precision=\"8\">" + name +
                                 ":/surface/positions<"));
  EXPECT_THAT(written, HasSubstr("0 1  1 1  126 1"));
  EXPECT_EQ(count(written, "AttributeType=\"Vector\""), 2U);
  EXPECT_EQ(count(written, "<DataItem "), count(written, "</DataItem>"));
  EXPECT_EQ(count(written, "<Attribute "), count(written, "</Attribute>"));
}

TEST(WriteXdmf, RefusesABadModel) {
  EXPECT_THROW(modelfile::writeXdmf("/nonexistent/model.h5"), LoadError);
}

}  // namespace palpate::testing
