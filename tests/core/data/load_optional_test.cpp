// SPDX-License-Identifier: Apache-2.0
// What a model file may have or not: regions of other materials, a certificate; and triangles between contact positions.
#include <gtest/gtest.h>

#include <functional>

#include "../load_case.h"

namespace palpate::testing {

namespace {

using modelfile::ModelData;

ModelData twoRegions() {
  ModelData data = goodData();
  data.mesh_element_region.assign(data.mesh_tetrahedron_tag.size(), 0);
  data.mesh_element_region.back() = 1;
  data.region_name = {regionName("parenchyma"), regionName("vessel")};
  data.region_E = {160e3, 500e3};
  data.region_nu = {0.48, 0.3};
  data.region_law = {regionName("stvk"), regionName("stable-neo-hookean")};
  data.spring_node = {2, 0};
  data.spring_stiffness = {120.0, 0.5};
  return data;
}

ModelData certified(const std::string& text) {
  ModelData data = goodData();
  data.attributes.certificate = text;
  return data;
}

void copyThing(const std::filesystem::path& from, const std::filesystem::path& to, const char* name) {
  const Hdf5Handle source = openForSpoiling(from), target = openForSpoiling(to);
  ASSERT_GE(H5Ocopy(source.get(), name, target.get(), name, H5P_DEFAULT, H5P_DEFAULT), 0);
}

/// Writes `name` of one file into another.
void copyText(const std::filesystem::path& from, const std::filesystem::path& to, const char* name) {
  const Hdf5Handle source = openForSpoiling(from), target = openForSpoiling(to);
  const Hdf5Handle attribute(H5Aopen(source.get(), name, H5P_DEFAULT), H5Aclose);
  const Hdf5Handle type(H5Aget_type(attribute.get()), H5Tclose),
      space(H5Aget_space(attribute.get()), H5Sclose);
  char* text = nullptr;
  H5Aread(attribute.get(), type.get(), &text);
  if (H5Aexists(target.get(), name) > 0) H5Adelete(target.get(), name);
  const Hdf5Handle copy(H5Acreate2(target.get(), name, type.get(), space.get(), H5P_DEFAULT, H5P_DEFAULT),
                        H5Aclose);
  H5Awrite(copy.get(), type.get(), &text);
  H5free_memory(text);
}

}  // namespace

TEST(LoadRegions, ComeBackAndAreInTheDigest) {
  const TemporaryFile file("regions.h5");
  ModelData data = twoRegions();
  modelfile::writeModel(file.path(), data);
  const MetaModel model = MetaModel::load(file.path());
  EXPECT_TRUE(sameBits(data.mesh_element_region, model.view().mesh_element_region));
  EXPECT_TRUE(sameBits(data.region_name, model.view().region_name));
  EXPECT_TRUE(sameBits(data.region_E, model.view().region_E));
  EXPECT_TRUE(sameBits(data.region_nu, model.view().region_nu));
  EXPECT_TRUE(sameBits(data.region_law, model.view().region_law));
  EXPECT_TRUE(sameBits(data.spring_node, model.view().spring_node));
  EXPECT_TRUE(sameBits(data.spring_stiffness, model.view().spring_stiffness));
  for (const std::function<void()>& change :
       {std::function<void()>([&] { data.region_E[1] = 501e3; }),
        std::function<void()>([&] { data.region_name[0][3] = 'E'; }),
        std::function<void()>([&] { data.region_law[1] = data.region_law[0]; }),
        std::function<void()>([&] { data.spring_node[0] = 3; }),
        std::function<void()>([&] { data.spring_stiffness[0] = 121.0; }),
        std::function<void()>([&] { data.mesh_element_region[0] = 1; })}) {
    const std::string before = MetaModel::load(file.path()).id();
    change();
    modelfile::writeModel(file.path(), data);
    EXPECT_NE(MetaModel::load(file.path()).id(), before);
  }
}

TEST(LoadRegions, NeedNotBeThere) {
  const TemporaryFile file("no-regions.h5");
  modelfile::writeModel(file.path(), goodData());
  const MetaModel model = MetaModel::load(file.path());
  EXPECT_TRUE(model.view().mesh_element_region.empty());
  EXPECT_TRUE(model.view().region_name.empty());
  EXPECT_TRUE(model.view().spring_node.empty());
  EXPECT_TRUE(model.attributes().certificate.empty());
}

TEST(LoadRegions, AreRefusedWhereTheyMakeNoSense) {
  const std::vector<std::pair<std::string, std::function<void(ModelData&)>>> cases{
      {"/mesh/element_region number 3 is 2, expected 0 to 1",
       [](ModelData& d) { d.mesh_element_region[3] = 2; }},
      {"/regions/name number 1 is empty, expected a name", [](ModelData& d) { d.region_name[1] = {}; }},
      {"/regions/E number 0 is 0, expected more than 0 Pa", [](ModelData& d) { d.region_E[0] = 0.0; }},
      {"/regions/nu number 1 is 0.5, expected more than -1 and less than 0.5",
       [](ModelData& d) { d.region_nu[1] = 0.5; }},
      {"/regions/law number 1 is \"hooke\", expected \"stvk\" or \"stable-neo-hookean\"",
       [](ModelData& d) { d.region_law[1] = regionName("hooke"); }},
      {"/springs/node number 1 is -1, expected 0 to ", [](ModelData& d) { d.spring_node[1] = -1; }},
      {"/springs/stiffness number 0 is 0, expected more than 0 N/m",
       [](ModelData& d) { d.spring_stiffness[0] = 0.0; }},
      {"/contact/triangles has 79 triangles, expected 80, as /surface/triangles, or a quarter of that",
       [](ModelData& d) {
         d.contact_triangles = d.surface_triangles;
         d.contact_triangles.resize(3 * 79);
       }},
      {"/contact/triangles number 5 is 7, expected ",
       [](ModelData& d) {
         d.contact_triangles = d.surface_triangles;
         d.contact_triangles[5] = 7;
       }},
  };
  for (const auto& [expected, spoil] : cases) {
    ModelData data = twoRegions();
    ASSERT_NE(data.surface_triangles[5], 7);
    spoil(data);
    const TemporaryFile file("wrong-regions.h5");
    modelfile::writeModel(file.path(), data);
    expectRefused(file.path(), expected);
  }
}

TEST(LoadRegions, ComeWholeOrNot) {
  for (const char* one : {"mesh/element_region", "regions/name", "regions/E", "regions/nu", "regions/law",
                          "springs/node", "springs/stiffness"}) {
    const TemporaryFile file("some-regions.h5");
    modelfile::writeModel(file.path(), twoRegions());
    deleteThing(file.path(), nullptr, one);
    expectRefused(file.path(), std::string("/") + one + " is missing");
  }
}

TEST(LoadEdges, ComeWholeOrNot) {
  for (const char* one : {"edges/offset", "edges/node", "edges/field", "edges/scale"}) {
    const TemporaryFile file("some-edges.h5");
    modelfile::writeModel(file.path(), goodData());
    deleteThing(file.path(), nullptr, one);
    expectRefused(file.path(), std::string("/") + one + " is missing");
  }
}

TEST(LoadEdges, DoNotBelongToLoadDrivenModels) {
  const TemporaryFile file("force.h5"), other("displacement.h5");
  modelfile::writeModel(file.path(), goodData(Parameters::kForce));
  modelfile::writeModel(other.path(), goodData());
  copyThing(other.path(), file.path(), "edges");
  expectRefused(file.path(), "has /edges, expected none in a model driven by force");
}

TEST(LoadCertificate, ComesBackAndIsNotInTheModelsId) {
  const TemporaryFile file("certified.h5"), bare("bare.h5");
  const std::string text = R"({"field_error_p95": 0.02})";
  modelfile::writeModel(file.path(), certified(text));
  modelfile::writeModel(bare.path(), goodData());
  const MetaModel model = MetaModel::load(file.path());
  EXPECT_EQ(model.attributes().certificate, text);
  EXPECT_EQ(model.id(), MetaModel::load(bare.path()).id());
}

TEST(LoadCertificate, HasAtMost64KiB) {
  const TemporaryFile file("long.h5");
  const std::string longest(65536, 'x');
  modelfile::writeModel(file.path(), certified(longest));
  EXPECT_EQ(MetaModel::load(file.path()).attributes().certificate, longest);
  modelfile::writeModel(file.path(), certified(longest + 'x'));
  expectRefused(file.path(), "attribute certificate is 65537 bytes, expected at most 65536");
}

TEST(LoadCertificate, OfAnotherContentIsRefused) {
  const TemporaryFile other("other.h5"), file("this.h5");
  ModelData data = certified("{}");
  modelfile::writeModel(other.path(), data);
  data.attributes.nu = 0.47;
  modelfile::writeModel(file.path(), data);
  const std::string theirs = MetaModel::load(other.path()).digest().hex(),
                    ours = MetaModel::load(file.path()).digest().hex();
  copyText(other.path(), file.path(), "certificate_of");
  expectRefused(file.path(), "the certificate belongs to the content " + theirs +
                                 ", the digest of this content is " + ours);
}

TEST(LoadCertificate, ThatWasChangedIsRefused) {
  const TemporaryFile other("other.h5"), file("this.h5");
  modelfile::writeModel(other.path(), certified(R"({"field_error_p95": 0.01})"));
  modelfile::writeModel(file.path(), certified(R"({"field_error_p95": 0.02})"));
  copyText(other.path(), file.path(), "certificate");
  expectRefused(file.path(), "the certificate_digest of its content is ");
}

}  // namespace palpate::testing
