// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "../driver.h"
#include "../patch_nodes.h"
#include "core/surface/surface_distance.h"
#include "palpate/testing/synthetic_model.h"
#include "tools/modelfile/write_model.h"

namespace palpate::testing {

TEST(SurfaceDistance, IsTheArcOnASphere) {
  const MetaModel model = loadSynthetic();
  const SurfaceGraph graph(model.view().surface_positions, model.view().surface_triangles);
  SurfaceFront front(graph);
  for (const int start : {0, 100, 300}) {
    const Vec3 n = nodePosition(model, start).normalized();
    const auto& found = front.from(model.surface().atNode(start), 0.06);
    EXPECT_GT(found.size(), 150U);
    for (const auto& [node, r] : found) {
      const double arc = 0.05 * std::acos(std::min(1.0, n.dot(nodePosition(model, node).normalized())));
      EXPECT_NEAR(r, arc, 0.03 * arc + 1e-8) << "from node " << start << " to " << node;
    }
  }
}

TEST(SurfaceDistance, AreasOfTheNodesAreThatOfTheSphere) {
  const MetaModel model = loadSynthetic();
  const SurfaceGraph graph(model.view().surface_positions, model.view().surface_triangles);
  const std::vector<double> areas = graph.lumpedAreas();
  EXPECT_NEAR(std::accumulate(areas.begin(), areas.end(), 0.0), 4.0 * M_PI * 0.05 * 0.05,
              0.02 * 4.0 * M_PI * 0.0025);
}

TEST(ContactPatchesOfAModel, WeightsFallAsTheTaperedGaussianAndLeaveOutFixedNodes) {
  const MetaModel model = loadSynthetic();
  const double a = model.attributes().patch_radius;
  const SurfaceGraph graph(model.view().surface_positions, model.view().surface_triangles);
  const std::vector<double> area = graph.lumpedAreas();
  bool cut = false;
  for (std::int32_t m = 0; m < static_cast<std::int32_t>(model.view().positions()); ++m) {
    const std::int32_t centre = model.view().contact_node[static_cast<std::size_t>(m)];
    const PatchNodes patch = patchAt(model, model.surface().atNode(centre));
    ASSERT_GT(patch.count, 3U);
    const auto at = static_cast<std::size_t>(std::find(patch.node.begin(), patch.node.end(), centre) -
                                             patch.node.begin());
    ASSERT_LT(at, patch.count);
    EXPECT_NEAR(
        std::accumulate(patch.weight.begin(), patch.weight.begin() + std::ptrdiff_t(patch.count), 0.0), 1.0,
        1e-12);
    const Vec3 n = nodePosition(model, centre).normalized();
    for (std::size_t i = 0; i < patch.count; ++i) {
      const Vec3 other = nodePosition(model, patch.node[i]).normalized();
      ASSERT_GE(model.view().position_of_node[static_cast<std::size_t>(patch.node[i])], 0) << "fixed";
      const double r = 0.05 * std::acos(std::min(1.0, n.dot(other)));
      const double z = std::clamp((r / (3.0 * a) - 0.6) / 0.4, 0.0, 1.0);
      const double taper = 1.0 - z * z * z * (10.0 - 15.0 * z + 6.0 * z * z);
      const double expected = area[static_cast<std::size_t>(patch.node[i])] /
                              area[static_cast<std::size_t>(centre)] * std::exp(-0.5 * r * r / (a * a)) *
                              taper;
      EXPECT_NEAR(patch.weight[i] / patch.weight[at], expected, 0.15 * expected + 2e-4);
    }
    cut = cut || n.z() < -0.6;
  }
  EXPECT_TRUE(cut) << "no patch met the fixed nodes";
}

TEST(ContactPatchesOfAModel, RefusesPatchesThatWouldFillTheMemory) {
  modelfile::ModelData data = syntheticModel({.subdivisions = 4});
  data.attributes.patch_radius = 1.0;
  const TemporaryFile file("wide.h5");
  modelfile::writeModel(file.path(), data);
  try {
    (void)MetaModel::load(file.path());
    FAIL() << "accepted";
  } catch (const LoadError& error) {
    EXPECT_NE(std::string(error.what()).find("patch_radius is 1.000000 m"), std::string::npos)
        << error.what();
  }
}

}  // namespace palpate::testing
