// SPDX-License-Identifier: Apache-2.0
#include "tools/program/vtu.h"

#include <gtest/gtest.h>

#include <stdexcept>

#include "palpate/testing/xml_fault.h"
#include "tools/program/xml.h"

namespace palpate::program {
namespace {

PointSurface oneTriangle() {
  return {.points = {0, 0, 0, 0.1, 0, 0, 0, 1.0 / 3.0, 0}, .triangles = {0, 1, 2}, .data = {}};
}

std::string complaintAbout(const PointSurface& surface) {
  try {
    (void)vtuText(surface);
    return {};
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
}

TEST(Xml, EscapedTextStaysTextAndAttribute) {
  EXPECT_EQ(xmlEscaped("a<b> & \"c\""), "a&lt;b&gt; &amp; &quot;c&quot;");
}

TEST(Vtu, HoldsEachKindOfNumberInFull) {
  PointSurface surface = oneTriangle();
  surface.data = {{"tag", std::vector<std::int64_t>{7, -8, 9'000'000'000}},
                  {"flag", std::vector<std::uint8_t>{0, 1, 255}},
                  {"a & b", std::vector<float>{0.1F, 0, 0, 0, 0, 0, 0, 0, 0}}};
  const std::string text = vtuText(surface);
  EXPECT_EQ(testing::xmlFault(text), "");
  for (const char* part :
       {"NumberOfPoints=\"3\" NumberOfCells=\"1\"",
        "<DataArray type=\"Float64\" Name=\"Points\" NumberOfComponents=\"3\" format=\"ascii\">\n"
        "0 0 0\n0.1 0 0\n0 0.3333333333333333 0\n</DataArray>",
        "<DataArray type=\"Int64\" Name=\"tag\" format=\"ascii\">\n7\n-8\n9000000000\n</DataArray>",
        "<DataArray type=\"UInt8\" Name=\"flag\" format=\"ascii\">\n0\n1\n255\n</DataArray>",
        "Name=\"a &amp; b\" NumberOfComponents=\"3\" format=\"ascii\">\n0.1 0 0\n",
        "<PointData Vectors=\"a &amp; b\">", "Name=\"offsets\" format=\"ascii\">\n3\n",
        "Name=\"types\" format=\"ascii\">\n5\n"})
    EXPECT_NE(text.find(part), std::string::npos) << part << "\nin\n" << text;
}

TEST(Vtu, RefusesSizesThatDoNotFit) {
  PointSurface surface = oneTriangle();
  surface.data = {{"u", std::vector<double>(4)}};
  EXPECT_EQ(complaintAbout(surface), "u has 4 entries, expected 3 or 9");
  surface = oneTriangle();
  surface.points.pop_back();
  EXPECT_EQ(complaintAbout(surface), "points has 8 entries, expected three each");
  surface = oneTriangle();
  surface.triangles.pop_back();
  EXPECT_EQ(complaintAbout(surface), "triangles has 2 entries, expected three each");
}

}  // namespace
}  // namespace palpate::program
