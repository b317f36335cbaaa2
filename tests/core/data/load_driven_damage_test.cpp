// SPDX-License-Identifier: Apache-2.0
// Files of load-driven models that are right, and right but for some of their bytes.
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <tuple>

#include "../load_case.h"
#include "core/model/meta_model.h"
#include "core/response/patch_response.h"
#include "core/response/response.h"
#include "tools/modelfile/pack_fields.h"

namespace palpate::testing {

using modelfile::ModelData;

TEST(LoadDriven, GivesBackEveryBitThatWasWritten) {
  for (const Parameters parameters : {Parameters::kForce, Parameters::kLevel}) {
    const TemporaryFile file("load-driven-round-trip.h5");
    const ModelData data = goodData(parameters);
    modelfile::writeModel(file.path(), data);
    const MetaModel model = MetaModel::load(file.path());
    const ModelAttributes &a = data.attributes, &b = model.attributes();
    EXPECT_EQ(b.parameters, parameters);
    EXPECT_TRUE(sameBits(data.contact_displacement, model.view().contact_displacement));
    EXPECT_TRUE(sameBits(data.contact_domain_radius, model.view().contact_domain_radius));
    EXPECT_TRUE(sameBits(data.levels_Z, model.view().levels_Z));
    EXPECT_TRUE(sameBits(modelfile::packFields(data).Y.whole, model.view().modes_Y));
    EXPECT_TRUE(model.view().contact_force.empty());
    if (parameters == Parameters::kForce) {
      EXPECT_EQ(std::tie(a.order, a.reference_force), std::tie(b.order, b.reference_force));
    } else {
      EXPECT_EQ(std::tie(a.load, a.load_direction), std::tie(b.load, b.load_direction));
      EXPECT_EQ(model.view().level_functions, 3U);
    }
  }
}

TEST(LoadDriven, SurvivesDamagedNumbers) {
  std::mt19937 random(3);
  int refused = 0;
  for (int trial = 0; trial < 60; ++trial) {
    ModelData data = goodData(trial % 2 == 0 ? Parameters::kForce : Parameters::kLevel);
    for (int flips = 0; flips < 3; ++flips) {
      auto* const bytes = static_cast<unsigned char*>(static_cast<void*>(data.contact_displacement.data()));
      bytes[random() % (8 * data.contact_displacement.size())] = static_cast<unsigned char>(random());
    }
    if (trial % 6 < 2) data.contact_domain_radius[3] = 0.0;  // one of the many that is damaged too
    const TemporaryFile file("load-driven-fuzz.h5");
    modelfile::writeModel(file.path(), data);
    if (!complaint(file.path()).empty()) {
      ++refused;
      continue;
    }
    const MetaModel model = MetaModel::load(file.path());
    for (int triangle = 0; triangle < model.surface().triangles(); ++triangle) {
      Response out;
      const ResponseStatus status =
          respond(model, {triangle, {0.2, 0.3, 0.5}}, Vec3(0.001, -0.002, -0.003), out);
      EXPECT_TRUE(out.stiffness.allFinite() && out.displacement.allFinite());
      EXPECT_TRUE(std::isfinite(out.domain_radius) && out.parameter.allFinite());
      if (out.force.allFinite()) continue;
      EXPECT_EQ(status, ResponseStatus::kBeyond);
      EXPECT_EQ(out.stiffness, Mat3::Zero());
    }
  }
  EXPECT_GT(refused, 5);
  EXPECT_LT(refused, 55) << "some have to be answered";
}

}  // namespace palpate::testing
