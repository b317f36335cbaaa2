// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "palpate/client/error.h"
#include "palpate/report/vtk_surface.h"
#include "palpate/testing/files.h"
#include "palpate/testing/xml_fault.h"
#include "small_surface.h"

namespace palpate::report {
namespace {

std::string written(const std::string& extension) {
  palpate::testing::SmallSurface source;
  std::vector<float> u(15, 0.0F);
  u[14] = -0.01F;  // the apex moves down
  const testing::TemporaryFile file("surface" + extension);
  writeSurface(file.path(), client::checkedSurface(source.message()), u);
  return testing::contentOf(file.path());
}

TEST(Vtk, XmlIsWellFormedAndDisplaced) {
  const std::string text = written(".vtu");
  EXPECT_EQ(palpate::testing::xmlFault(text), "");
  EXPECT_NE(text.find("NumberOfPoints=\"5\" NumberOfCells=\"6\""), std::string::npos);
  EXPECT_NE(text.find("0.05 0.05 0.04"), std::string::npos) << text;
}

TEST(Vtk, LegacyHoldsPointsPolygonsAndVectors) {
  const std::string text = written(".vtk");
  EXPECT_EQ(text.rfind("# vtk DataFile Version 3.0\n", 0), 0U);
  EXPECT_NE(text.find("POINTS 5 double\n0 0 0\n"), std::string::npos);
  EXPECT_NE(text.find("POLYGONS 6 24\n3 0 2 1\n"), std::string::npos);
  EXPECT_NE(text.find("VECTORS displacement float\n"), std::string::npos);
}

TEST(Vtk, RejectsWhatItCannotWrite) {
  palpate::testing::SmallSurface source;
  const auto surface = client::checkedSurface(source.message());
  try {
    writeSurface("field.stl", surface, std::vector<float>(15));
    FAIL() << "wrote .stl";
  } catch (const client::ClientError& error) {
    EXPECT_STREQ(error.what(), "cannot write field.stl: expected a name that ends in .vtu or .vtk");
  }
  try {
    writeSurface("field.vtk", surface, std::vector<float>(12));
    FAIL() << "wrote a field of another size";
  } catch (const client::ClientError& error) {
    EXPECT_STREQ(error.what(), "displacement has 12 entries, expected 15");
  }
}

}  // namespace
}  // namespace palpate::report
