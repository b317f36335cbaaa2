// SPDX-License-Identifier: Apache-2.0
#include "tools/make/organ/size_estimate.h"

#include "helpers.h"
#include "spoiled_sphere.h"
#include "tools/mesh/fill_surface.h"
#include "tools/mesh/quadratic.h"

namespace palpate::organ::test {
namespace {

Body bodyOf(const mesh::TriangleSurface& surface) {
  return {mesh::enclosedVolume(surface), mesh::areaOf(surface), 0.1};
}

// Held against what Gmsh makes of a ball of 0.1 m.
TEST(SizeEstimate, ComesNearWhatGmshMakes) {
  const mesh::TriangleSurface ball = sphere(0.05, 4);
  for (const mesh::ElementSizes sizes :
       {mesh::ElementSizes{0.015}, mesh::ElementSizes{0.006}, mesh::ElementSizes{0.006, 0.02, 0.5}}) {
    const mesh::TetMesh made = mesh::fillSurface(ball, sizes);
    const SizeEstimate expected = estimate(bodyOf(ball), sizes, 1);
    EXPECT_NEAR(expected.nodes / static_cast<double>(made.nodes.size()), 1, 0.4) << sizes.surface;
    EXPECT_NEAR(expected.tetrahedra / static_cast<double>(made.tetrahedra.size()), 1, 0.4) << sizes.surface;
    const double quadratic = static_cast<double>(mesh::quadraticOf(made).nodes.size());
    EXPECT_NEAR(estimate(bodyOf(ball), sizes, 2).nodes / quadratic, 1, 0.4) << sizes.surface;
  }
}

TEST(SizeEstimate, TheSmallestSizeHasAsManyNodesAsAllowed) {
  const Body body{1e-3, 0.06, 0.1};
  for (const int order : {1, 2}) {
    for (const mesh::ElementSizes sizes :
         {mesh::ElementSizes{0.001}, mesh::ElementSizes{0.001, 0.003, 0.5}}) {
      const double size = smallestSize(body, sizes, order, 20000);
      const mesh::ElementSizes fitting{size, sizes.inner / sizes.surface * size, sizes.growth};
      EXPECT_NEAR(estimate(body, fitting, order).nodes, 20000, 1);
    }
  }
}

}  // namespace
}  // namespace palpate::organ::test
