// SPDX-License-Identifier: Apache-2.0
#include "tools/examine/query/field_file.h"

#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "box_model.h"
#include "palpate/testing/xml_fault.h"

namespace palpate::query::test {
namespace {

/// The numbers of the DataArray of that name; empty if there is none.
std::vector<double> arrayOf(const std::string& vtu, const std::string& name) {
  const std::size_t named = vtu.find("Name=\"" + name + "\"");
  if (named == std::string::npos) return {};
  const std::size_t begin = vtu.find('>', named) + 1;
  std::istringstream in(vtu.substr(begin, vtu.find('<', begin) - begin));
  return {std::istream_iterator<double>(in), {}};
}

TEST(FieldFile, HoldsModelTruthAndTheirDifference) {
  const BoxModel box;
  const Vec3 d(0.0, 0.0, -0.002);
  const Anchor anchor = anchorAtNode(box.model, BoxMesh::number(4, 1, 2));
  const Answer answer = ask(box.model, anchor, d);
  const FullSolution truth = box.solve(anchor, d);
  const std::string vtu = fieldVtu(box.model, answer, &box.organ, &truth);
  EXPECT_EQ(testing::xmlFault(vtu), "");
  const std::size_t nodes = box.organ.surface.nodes.size(), triangles = box.model.view().triangles();
  const auto u = arrayOf(vtu, "displacement"), full = arrayOf(vtu, "newton"), error = arrayOf(vtu, "error");
  ASSERT_EQ(u.size(), 3 * nodes);
  ASSERT_EQ(full.size(), 3 * nodes);
  ASSERT_EQ(error.size(), 3 * nodes);
  for (std::size_t i = 0; i < 3 * nodes; ++i) {
    EXPECT_EQ(u[i], static_cast<double>(answer.field[i]));
    EXPECT_EQ(full[i], truth.displacement(box.organ, static_cast<int>(i / 3))[static_cast<int>(i % 3)]);
    EXPECT_EQ(error[i], u[i] - full[i]);
  }
  EXPECT_EQ(arrayOf(vtu, "Points").size(), 3 * nodes);
  EXPECT_EQ(arrayOf(vtu, "mesh_tag").size(), nodes);
  EXPECT_EQ(arrayOf(vtu, "connectivity").size(), 3 * triangles);
  EXPECT_EQ(arrayOf(vtu, "offsets").back(), static_cast<double>(3 * triangles));
  EXPECT_EQ(arrayOf(vtu, "types"), std::vector<double>(triangles, 5.0));
}

TEST(FieldFile, HoldsTheModelAloneWithoutTruth) {
  const BoxModel box;
  const Answer answer = ask(box.model, anchorAtNode(box.model, BoxMesh::number(4, 1, 2)), {0, 0, -0.002});
  const std::string vtu = fieldVtu(box.model, answer, nullptr, nullptr);
  EXPECT_EQ(testing::xmlFault(vtu), "");
  EXPECT_EQ(arrayOf(vtu, "displacement").size(), 3 * box.organ.surface.nodes.size());
  EXPECT_TRUE(arrayOf(vtu, "newton").empty());
  EXPECT_TRUE(arrayOf(vtu, "error").empty());
}

}  // namespace
}  // namespace palpate::query::test
