// SPDX-License-Identifier: Apache-2.0
#include "tools/examine/query/place.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "box_model.h"
#include "core/model/contact_radius.h"
#include "load_models.h"
#include "tools/examine/query/batch.h"
#include "tools/program/numbers.h"

namespace palpate::query::test {
namespace {

constexpr program::LengthUnit kMetres = program::kLengthUnits[0], kMillimetres = program::kLengthUnits[2];

std::string valueErrorOf(const std::function<void()>& work) {
  try {
    work();
  } catch (const program::ValueError& error) {
    return error.what();
  }
  return {};
}

TEST(Place, DistanceIsToTheTrianglesNotToTheNodes) {
  const BoxModel box;
  const Vec3 middle(0.07, 0.03, 0.043);  // 3 mm above the middle of a cell, whose nodes are 14 mm away
  const Anchor anchor = anchorOf(box.model, {"--at", {middle[0], middle[1], middle[2]}});
  EXPECT_NEAR(anchor.distance.value(), 0.003, 1e-15);
  EXPECT_LT((anchor.position - Vec3(0.07, 0.03, 0.04)).norm(), 1e-15);
  EXPECT_NEAR(anchorOf(box.model, {"--at", {70.0, 30.0, 38.0}, kMillimetres, true}).distance.value(), -0.002,
              1e-15);
  EXPECT_FALSE(anchorAtNode(box.model, BoxMesh::number(4, 2, 2)).distance);
}

TEST(Place, RefusesAPlaceFartherThanAPatchRadius) {
  const BoxModel box;
  EXPECT_EQ(contactRadius(box.model), 0.012);
  EXPECT_EQ(valueErrorOf([&] { (void)anchorOf(box.model, {"--at", {0.07, 0.03, 0.0519}}); }), "");
  EXPECT_NE(valueErrorOf([&] {
              (void)anchorOf(box.model, {"--at", {0.07, 0.03, 0.0521}});
            }).find("lies 12.1 mm from the organ's surface, expected at most 12 mm"),
            std::string::npos);
  EXPECT_NE(valueErrorOf([&] {
              (void)anchorOf(box.model, {"--at", {70.0, 30.0, 41.0}, kMetres, true});
            }).find("in millimetres it would lie 1 mm from the organ's surface: --unit mm"),
            std::string::npos);
}

TEST(Place, APlaceOfNodalLoadsIsWithinAMeanEdge) {
  const LoadModel nodal(Parameters::kForce, 2e-8);
  const double radius = contactRadius(MetaModel::load(nodal.path));
  EXPECT_GT(radius, 0.02);  // cells of 20 mm, and their diagonals
  EXPECT_LT(radius, 0.0283);
}

TEST(Place, RefusesADisplacementThatIsNoTouchOfTheOrgan) {
  const BoxModel box;
  const auto& radii = box.model.view().contact_series_radius;
  const double travel = *std::max_element(radii.begin(), radii.end());
  EXPECT_DOUBLE_EQ(longestDisplacement(box.model), std::max(10.0 * travel, 0.1 * std::sqrt(0.0152)));
  const program::AskedPlace deep{"--displacement", {0.0, 0.0, -0.99 * longestDisplacement(box.model)}};
  EXPECT_EQ(displacementOf(box.model, deep).z(), deep.numbers[2]);
  EXPECT_EQ(displacementOf(box.model, {"--displacement", {0.0, 0.0, -2.0}, kMillimetres, true}).z(), -0.002);
  const std::string refused = valueErrorOf([&] {
    (void)displacementOf(box.model, {"--displacement", {0.0, 0.0, -2.0}, kMetres, true});
  });
  EXPECT_NE(refused.find("--displacement 0,0,-2 m is 2 m long, expected at most "), std::string::npos)
      << refused;
  EXPECT_NE(refused.find("of an organ of 123.3 mm"), std::string::npos) << refused;
  EXPECT_NE(refused.find("in millimetres it would be 2 mm: --unit "), std::string::npos) << refused;
}

TEST(Batch, AnswersAsOneQueryForEachLine) {
  const BoxModel box;
  const std::vector<TouchRow> rows = touchesIn("t.csv",
                                               "at_x,at_y,at_z,displacement_x,displacement_y,displacement_"
                                               "z\n83,31,41,0,0,-2\n-5,30,20,1,0,0\n83,31,40,0,0,-100\n",
                                               kMillimetres);
  ASSERT_EQ(rows.size(), 3U);
  const std::vector<BatchAnswer> answers = answersTo(box.model, std::span(rows).first(2));
  const Anchor anchor = anchorNear(box.model, {0.083, 0.031, 0.041});
  const Answer answer = ask(box.model, anchor, Vec3(0.0, 0.0, -0.002));
  EXPECT_EQ(answers[0].answer.response.force, answer.response.force);
  EXPECT_NEAR(answers[0].anchor.distance.value(), 0.001, 1e-15);
  EXPECT_FALSE(answers[0].clamped());
  EXPECT_EQ(answers[1].answer.status, ResponseStatus::kNoAnswer);
  const std::string text = batchText(answers);
  EXPECT_EQ(text.find(batchColumns() + "\n83,31,41,0,0,-2,"), 0U) << text;
  EXPECT_NE(text.find("\n-5,30,20,1,0,0,0,0,0,not_accessible,0.005,0,no,0,0,0\n"), std::string::npos) << text;
}

TEST(Batch, SaysWhatWasClamped) {
  const BoxModel box;
  const double deep = 0.999 * longestDisplacement(box.model);
  const std::vector<TouchRow> rows{{{"at", {0.083, 0.031, 0.04}}, {"displacement", {0.0, 0.0, -deep}}}};
  const BatchAnswer answer = answersTo(box.model, rows).front();
  EXPECT_TRUE(answer.clamped());
  EXPECT_LT(answer.answer.response.displacement.norm(), deep);
  EXPECT_NE(batchText(std::span(&answer, 1)).find(",beyond_domain,"), std::string::npos);
}

TEST(Batch, ReadsColumnsInAnyOrderAndWhatProgramsWrite) {
  const auto rows =
      touchesIn("t.csv",
                "\xEF\xBB\xBF# mine\r\ndisplacement_z, displacement_y,displacement_x,at_z,at_y,at_x\r\n\r\n"
                "6, 5,4,3,2, 1e0\r\n",
                kMetres);
  ASSERT_EQ(rows.size(), 1U);
  EXPECT_EQ(rows[0].at.numbers, (program::Point{1.0, 2.0, 3.0}));
  EXPECT_EQ(rows[0].displacement.numbers, (program::Point{4.0, 5.0, 6.0}));
  EXPECT_EQ(rows[0].at.name, "t.csv, line 4, at");
}

TEST(Batch, NamesFileLineAndColumnOfWhatItCannotRead) {
  const std::string titles = "at_x,at_y,at_z,displacement_x,displacement_y,displacement_z\n";
  const auto error = [&](const std::string& text) {
    return errorOf([&] { (void)touchesIn("t.csv", text, kMetres); });
  };
  EXPECT_EQ(error(titles + "0,0,0,0,0,0\n0,x,0,0,0,0\n"),
            "t.csv, line 3, column at_y: 'x' is not a finite number");
  EXPECT_EQ(error(titles + "0,0,0,0,0,inf\n"),
            "t.csv, line 2, column displacement_z: 'inf' is not a finite number");
  EXPECT_EQ(error(titles + "0,0,0,0,0,\n"),
            "t.csv, line 2, column displacement_z: '' is not a finite number");
  EXPECT_EQ(error(titles + "0,0,0,0,0\n"), "t.csv, line 2 has 5 values, expected 6");
  EXPECT_EQ(error(titles), "t.csv has no line below that of its columns");
  EXPECT_EQ(error(""), "t.csv is empty, expected a line of columns: " + titles.substr(0, titles.size() - 1));
  EXPECT_EQ(error("0,0,0,0,0,-1\n").find("t.csv, line 1: column '0' is not known, expected at_x,"), 0U);
  EXPECT_NE(error("at_x,at_y,displacement_x,displacement_y,displacement_z\n").find("no column is at_z"),
            std::string::npos);
  EXPECT_NE(error("at_x," + titles).find("two columns are at_x"), std::string::npos);
}

TEST(Batch, NamesTheLineOfAPlaceOffTheOrgan) {
  const BoxModel box;
  const auto rows = touchesIn(
      "t.csv",
      "at_x,at_y,at_z,displacement_x,displacement_y,displacement_z\n0.08,0.03,0.04,0,0,0\n70,30,41,0,0,0\n",
      kMetres);
  const std::string refused = errorOf([&] { (void)answersTo(box.model, rows); });
  EXPECT_NE(refused.find("t.csv, line 3, at 70,30,41 m lies "), std::string::npos) << refused;
}

}  // namespace
}  // namespace palpate::query::test
