// SPDX-License-Identifier: Apache-2.0
// The contrast of a round organ that is stiffer round its top, against the same organ without that: known in closed form.
#include "tools/examine/feel/contrast.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "palpate/testing/xml_fault.h"
#include "stiffer_top.h"
#include "tools/examine/feel/contrast_map.h"

namespace palpate::testing {

namespace {

constexpr double kDepth = 0.005;  // m

const MetaModel& stiffer() {
  static const MetaModel model = modelOf(stifferTop(kMost));
  return model;
}

const MetaModel& plain() {
  static const MetaModel model = modelOf(stifferTop(0.0));
  return model;
}

const feel::Pair& pair() {
  static const feel::Pair pair{stiffer(), plain()};
  return pair;
}

Vec3 positionOf(std::size_t node) {
  return Eigen::Map<const Vec3>(stiffer().view().surface_positions.data() + 3 * node);
}

/// Why a model cannot be compared with the plain one.
std::string refusal(const modelfile::ModelData& data) {
  const MetaModel model = modelOf(data);
  try {
    feel::checkComparable({model, plain()});
  } catch (const feel::ModelsDiffer& error) {
    return error.what();
  }
  return "";
}

}  // namespace

TEST(Contrast, IsTheRatioOfStiffnessesAtEveryAccessibleNode) {
  const feel::ContrastField field = feel::contrastField(pair(), kDepth);
  const auto accessible = stiffer().accessibleNodes();
  std::size_t places = 0;
  for (std::size_t node = 0; node < accessible.size(); ++node) {
    ASSERT_EQ(field.presses[node].has_value(), accessible[node] != 0) << node;
    if (accessible[node] == 0) continue;
    ++places;
    EXPECT_NEAR(field.presses[node]->contrast(), contrastAt(positionOf(node)), 1e-6) << node;
    EXPECT_NEAR(field.presses[node]->without_force, 1.5 * kTopOptions.stiffness * kDepth,
                0.2 * kTopOptions.stiffness * kDepth);
  }
  EXPECT_EQ(field.places(), places);
  EXPECT_GT(places, 1500U);
  EXPECT_EQ(field.unanswered, 0U);
}

TEST(Contrast, PressesBeyondTheDomainAreCounted) {
  EXPECT_EQ(feel::contrastField(pair(), 0.99 * kTopOptions.domain_radius).beyond(), 0U);
  const feel::ContrastField deep = feel::contrastField(pair(), 1.01 * kTopOptions.domain_radius);
  EXPECT_EQ(deep.beyond(), deep.places());
}

TEST(Contrast, FallsWithTheDistanceFromItsLargestPlace) {
  const feel::ContrastField field = feel::contrastField(pair(), kDepth);
  const std::size_t most = feel::largest(field);
  EXPECT_LT((positionOf(most) - kTop).norm(), 1e-9);
  const auto rings = feel::ringsRound(stiffer(), field, most);
  ASSERT_EQ(rings.size(), 6U);
  std::size_t places = 0;
  for (const feel::Ring& ring : rings) places += ring.places;
  EXPECT_EQ(places, field.places());
  EXPECT_NEAR(rings[0].max, kMost, 1e-6);
  EXPECT_EQ(rings[3].from, 0.025);
  EXPECT_EQ(rings[3].to, 0.035);
  EXPECT_LE(rings[3].max, contrastAt(0.025));
  EXPECT_GT(rings[3].max, contrastAt(0.028)) << "nodes are 3.5 mm apart";
  EXPECT_GE(rings[3].min, contrastAt(0.035));
  EXPECT_LT(rings[3].min, contrastAt(0.032));
  // On a sphere as much area lies within the straight distance r as in a flat disk: pi r^2.
  for (const std::size_t r : {1U, 2U, 3U}) {
    const double from = std::pow(rings[r].from / kWidth, 2), to = std::pow(rings[r].to / kWidth, 2);
    const double mean = kMost * (std::exp(-from) - std::exp(-to)) / (to - from);
    EXPECT_NEAR(rings[r].mean, mean, 0.1 * mean) << r;
  }
}

TEST(Contrast, MeanOfARingIsByArea) {
  feel::ContrastField field = feel::contrastField(pair(), kDepth);
  const std::size_t most = feel::largest(field);
  for (std::size_t node = 0; node < field.area.size(); ++node)
    if (node != most) field.area[node] = 0.0;
  EXPECT_NEAR(feel::ringsRound(stiffer(), field, most)[0].mean, kMost, 1e-6);
}

TEST(Contrast, ShareAboveHalfIsThatOfTheCapRoundTheTop) {
  const double cap = kWidth * kWidth * std::log(2.0);  // r^2, m^2
  const double R = kTopOptions.radius;
  const double accessible = 2.0 * R * R * (1.0 - kTopOptions.helper_below);
  const double share = feel::shareAbove(feel::contrastField(pair(), kDepth), 0.5 * kMost);
  EXPECT_NEAR(share, cap / accessible, 0.2 * cap / accessible);
}

TEST(Contrast, OverARegionIsThatOfTheSurfaceAboveItsCentre) {
  const auto regions = feel::regionContrasts(pair(), kDepth);
  ASSERT_EQ(regions.size(), 1U) << "the tissue round it is none";
  EXPECT_EQ(regions[0].name, "nodule");
  EXPECT_LT(regions[0].surface.centre.head<2>().norm(), 1e-9);
  EXPECT_GT(regions[0].surface.centre.z(), 0.5 * kTopOptions.radius);
  EXPECT_LT((regions[0].above - kTop).norm(), 1e-3);
  ASSERT_TRUE(regions[0].press);
  EXPECT_NEAR(regions[0].press->contrast(), kMost, 0.01 * kMost);
}

TEST(Contrast, OfAnOrganWithItselfIsNone) {
  const feel::Pair same{plain(), plain()};
  const feel::ContrastField field = feel::contrastField(same, kDepth);
  EXPECT_EQ(field.presses[feel::largest(field)]->contrast(), 0.0);
  EXPECT_EQ(xmlFault(feel::contrastSvg(same, field, {}, kDepth)), "");
}

TEST(Contrast, RefusesAnotherSurfaceByItsFirstDifference) {
  EXPECT_EQ(refusal(stifferTop(kMost)), "");
  modelfile::ModelData data = stifferTop(0.0);
  data.surface_positions[3 * 41 + 1] += 1e-6;
  data.surface_positions[3 * 77] += 1e-6;
  EXPECT_EQ(refusal(data).find("the surfaces differ: node 42 of the mesh is at "), 0U) << refusal(data);
  SyntheticOptions options = kTopOptions;
  options.subdivisions = 3;
  EXPECT_EQ(refusal(syntheticModel(options)), "the surfaces differ: 642 nodes, without 2562");
  data = stifferTop(0.0);
  data.attributes.patch_radius = 0.007;
  EXPECT_EQ(refusal(data), "the patches differ: their radius is 0.007 m, without 0.008 m");
  data = stifferTop(0.0);
  data.contact_accessible[5] ^= 1U;
  EXPECT_NE(refusal(data).find("is accessible in one of the models only"), std::string::npos);
}

TEST(Contrast, OfAnOrganThatPullsIsUnanswered) {
  modelfile::ModelData data = stifferTop(0.0);
  const std::size_t width = data.contact_force.size() / data.contact_node.size();
  for (std::size_t i = 0; i < data.contact_stiffness.size(); ++i) data.contact_stiffness[i] *= -1.0;
  for (std::size_t i = 0; i < width * data.contact_node.size(); ++i) data.contact_force[i] *= -1.0;
  const MetaModel pulling = modelOf(data);
  const feel::ContrastField field = feel::contrastField({stiffer(), pulling}, kDepth);
  EXPECT_EQ(field.places(), 0U);
  EXPECT_GT(field.unanswered, 1500U);
  EXPECT_THROW((void)feel::largest(field), feel::ModelsDiffer);
}

TEST(ContrastMap, ShowsNumbersUnitsAndTheNodulesOutline) {
  const feel::ContrastField field = feel::contrastField(pair(), kDepth);
  const std::string svg = feel::contrastSvg(pair(), field, feel::regionContrasts(pair(), kDepth), kDepth);
  EXPECT_EQ(xmlFault(svg), "");
  for (const char* part : {">contrast / %<", "5 mm deep", ">largest contrast, 60 %<", ">50 mm<", ">0<",
                           ">60<", ">nodule, its centre ", "class=\"over dashed\""})
    EXPECT_NE(svg.find(part), std::string::npos) << part;
  EXPECT_EQ(svg.find("nan"), std::string::npos);
}

TEST(ContrastMap, VtkFileHoldsTheContrastOfEachNode) {
  feel::ContrastField field = feel::contrastField(pair(), kDepth);
  const std::string vtu = feel::contrastVtu(pair(), field);
  EXPECT_EQ(xmlFault(vtu), "");
  const std::size_t at = vtu.find("Name=\"contrast\"");
  ASSERT_NE(at, std::string::npos);
  EXPECT_NEAR(std::stod(vtu.substr(vtu.find('\n', at))), contrastAt(positionOf(0)), 1e-6);
  for (const char* name : {"force", "force_without", "beyond_domain", "pressed"})
    EXPECT_NE(vtu.find("Name=\"" + std::string(name) + "\""), std::string::npos) << name;
}

}  // namespace palpate::testing
