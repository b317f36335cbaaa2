// SPDX-License-Identifier: Apache-2.0
// A model of another E by palpate-fit --write, beside the one that the solver makes for that E.
#include <gtest/gtest.h>

#include "../query/box_model.h"
#include "palpate/testing/synthetic_model.h"
#include "tools/examine/query/answer.h"
#include "tools/modelfile/scale_model.h"
#include "tools/modelfile/write_certificate.h"

namespace palpate::fit::test {
namespace {

using palpate::testing::TemporaryFolder;
using query::Answer;
using query::test::BoxCase;
using query::test::BoxMesh;

/// Both answers to touches at a few nodes. @param field  allowed difference, over abs(d)
void expectTheSame(const MetaModel& a, const MetaModel& b, double force, double field) {
  for (const int i : {2, 4, 5})
    for (const Vec3& d : {Vec3(0.0, 0.0, -0.002), Vec3(0.001, -0.003, -0.001)}) {
      const std::int64_t node = BoxMesh::number(i, 2, 2);
      const Answer one = query::ask(a, query::anchorAtNode(a, node), d),
                   two = query::ask(b, query::anchorAtNode(b, node), d);
      EXPECT_EQ(one.status, two.status);
      EXPECT_LT((one.response.force - two.response.force).norm(), force * two.response.force.norm());
      EXPECT_LT((one.response.stiffness - two.response.stiffness).norm(),
                force * two.response.stiffness.norm());
      double largest = 0.0;
      for (std::size_t k = 0; k < one.field.size(); ++k)
        largest = std::max(largest, static_cast<double>(std::abs(one.field[k] - two.field[k])));
      EXPECT_LT(largest, field * d.norm());
    }
}

TEST(WrittenModel, IsWhatTheSolverMakesForThatModulus) {
  constexpr double kFactor = 0.35;
  const TemporaryFolder folder;
  for (const BoxCase::Kind kind : {BoxCase::kPlain, BoxCase::kRegionAndSprings}) {
    query::test::writeBoxModel(folder / "box.h5", "stvk", 1, kind);
    query::test::writeBoxModel(folder / "solved.h5", "stvk", 1, kind, kFactor);
    const MetaModel solved = MetaModel::load(folder / "solved.h5");
    modelfile::writeScaled(folder / "scaled.h5", MetaModel::load(folder / "box.h5"), solved.attributes().E,
                           "{}");
    const MetaModel scaled = MetaModel::load(folder / "scaled.h5");
    EXPECT_EQ(scaled.attributes().E, kFactor * 1e5);
    expectTheSame(scaled, solved, 1e-6, 2e-4);  // the solver keeps fields in floats
    for (std::size_t r = 0; r < solved.view().region_E.size(); ++r)
      EXPECT_DOUBLE_EQ(scaled.view().region_E[r], solved.view().region_E[r]);
    for (std::size_t i = 0; i < solved.view().spring_stiffness.size(); ++i)
      EXPECT_DOUBLE_EQ(scaled.view().spring_stiffness[i], solved.view().spring_stiffness[i]);
    const auto& one = scaled.view().contact_domain_radius;
    EXPECT_TRUE(std::equal(one.begin(), one.end(),
                           MetaModel::load(folder / "box.h5").view().contact_domain_radius.begin()));
  }
}

TEST(WrittenModel, HasNoCertificateAndSaysWhereItIsFrom) {
  const TemporaryFolder folder;
  query::test::writeBoxModel(folder / "box.h5");
  modelfile::writeCertificate(folder / "box.h5", R"({"samples": 59})",
                              MetaModel::load(folder / "box.h5").digest());
  const MetaModel box = MetaModel::load(folder / "box.h5");
  modelfile::writeScaled(folder / "scaled.h5", box, 2e5, R"({"fitted": 1})");
  const MetaModel scaled = MetaModel::load(folder / "scaled.h5");
  EXPECT_EQ(scaled.attributes().certificate, "");
  EXPECT_EQ(scaled.attributes().provenance, R"({"fitted": 1})");
  EXPECT_NE(scaled.id(), box.id());
}

TEST(WrittenModel, ASmallFileStaysSmall) {
  const TemporaryFolder folder;
  modelfile::ModelData data = palpate::testing::syntheticModel({.subdivisions = 2});
  data.compact = true;
  for (std::vector<double>* const numbers : {&data.contact_force, &data.contact_stiffness})
    for (double& number : *numbers) number = double{static_cast<float>(number)};
  modelfile::writeModel(folder / "small.h5", data);
  const MetaModel small = MetaModel::load(folder / "small.h5");
  modelfile::writeScaled(folder / "scaled.h5", small, small.attributes().E / 3.0, "{}");
  EXPECT_EQ(std::filesystem::file_size(folder / "scaled.h5"),
            std::filesystem::file_size(folder / "small.h5"));
  EXPECT_NEAR(MetaModel::load(folder / "scaled.h5").view().contact_force[0],
              small.view().contact_force[0] / 3.0, 1e-7 * std::abs(small.view().contact_force[0]));
}

TEST(WrittenModel, RefusesAModulusThatLeavesTheNumbers) {
  const TemporaryFolder folder;
  query::test::writeBoxModel(folder / "box.h5");
  const MetaModel box = MetaModel::load(folder / "box.h5");
  try {
    modelfile::writeScaled(folder / "scaled.h5", box, 1e-60, "{}");
    FAIL() << "no error";
  } catch (const modelfile::ModelFileError& error) {
    EXPECT_EQ(std::string(error.what()), "/green/near_scale has numbers that overflow at this E");
  }
  EXPECT_FALSE(std::filesystem::exists(folder / "scaled.h5"));
}

}  // namespace
}  // namespace palpate::fit::test
