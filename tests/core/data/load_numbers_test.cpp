// SPDX-License-Identifier: Apache-2.0
// Model files with numbers that do not make sense, each with its wrong value and its message.
#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <string>

#include "../load_case.h"

namespace palpate::testing {

using modelfile::ModelData;

struct WrongNumbers : LoadCase {
  std::function<void(ModelData&)> spoil;
};

class LoadRefusesNumbers : public ::testing::TestWithParam<WrongNumbers> {};

TEST_P(LoadRefusesNumbers, WithOneClearLine) {
  ModelData data = goodData();
  GetParam().spoil(data);
  const TemporaryFile file("numbers.h5");
  modelfile::writeModel(file.path(), data);
  expectRefused(file.path(), GetParam().expected);
}

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

void takeSeries(ModelData& d) {
  d.contact_domain_radius[2] = d.contact_series_radius[2] = 0.0;
}

INSTANTIATE_TEST_SUITE_P(
    All, LoadRefusesNumbers,
    ::testing::
        Values(
            WrongNumbers{{"Law", R"(law is "hooke", expected "stvk" or "stable-neo-hookean")"},
                         [](ModelData& d) { d.attributes.law = "hooke"; }},
            WrongNumbers{{"NegativeE", "E is -1, expected more than 0 Pa"},
                         [](ModelData& d) { d.attributes.E = -1.0; }},
            WrongNumbers{{"NanE", "E is nan, expected more than 0 Pa"},
                         [](ModelData& d) { d.attributes.E = kNaN; }},
            WrongNumbers{{"Incompressible", "nu is 0.5, expected more than -1 and less than 0.5"},
                         [](ModelData& d) { d.attributes.nu = 0.5; }},
            WrongNumbers{{"PatchRadius", "patch_radius is 0, expected more than 0 m"},
                         [](ModelData& d) { d.attributes.patch_radius = 0.0; }},
            WrongNumbers{{"NearRadius", "near_radius is -0.01, expected at least 0 m"},
                         [](ModelData& d) { d.attributes.near_radius = -0.01; }},
            WrongNumbers{{"ReferenceDisplacement", "reference_displacement is 0, expected more than 0 m"},
                         [](ModelData& d) { d.attributes.reference_displacement = 0.0; }},
            WrongNumbers{{"NanPosition", "/surface/positions number 7 is nan, expected a finite number"},
                         [](ModelData& d) { d.surface_positions[7] = kNaN; }},
            WrongNumbers{{"NanForce", "/contact/force number 3 is nan, expected a finite number"},
                         [](ModelData& d) { d.contact_force[3] = kNaN; }},
            WrongNumbers{{"NanStiffness", "/contact/stiffness number 30 is nan, expected a finite number"},
                         [](ModelData& d) { d.contact_stiffness[30] = kNaN; }},
            WrongNumbers{
                {"InfiniteMode", "/modes/X_scale number 0 is inf, expected more than 0, at most 1.03"},
                [](ModelData& d) { d.modes_X[5] = kInfinity; }},
            WrongNumbers{{"InfiniteAmplitude", "/modes/Y_scale number 0 is inf, expected more than 0"},
                         [](ModelData& d) { d.modes_Y[0] = kInfinity; }},
            WrongNumbers{{"InfiniteNearField", "/near/scale number 3 is inf, expected more than 0"},
                         [](ModelData& d) { d.near_field[9] = kInfinity; }},
            WrongNumbers{{"InfiniteGreensAmplitude", "/green/Y_scale number 1 is inf, expected more than 0"},
                         [](ModelData& d) { d.green_Y[2] = kInfinity; }},
            WrongNumbers{
                {"InfiniteGreensNearField", "/green/near_scale number 0 is inf, expected more than 0"},
                [](ModelData& d) { d.green_near[0] = kInfinity; }},
            WrongNumbers{{"NegativeDomain", "/contact/domain_radius number 2 is -0.001, expected at least 0"},
                         [](ModelData& d) { d.contact_domain_radius[2] = -0.001; }},
            WrongNumbers{{"SeriesEndsInTheDomain",
                          "/contact/series_radius number 2 is 0.007, expected at least "
                          "/contact/domain_radius = 0.008"},
                         [](ModelData& d) { d.contact_series_radius[2] = 0.007; }},
            WrongNumbers{{"NoSeries", "/contact/series_radius number 2 is 0, expected more than 0 m"},
                         takeSeries},
            WrongNumbers{{"NaNSeries", "/contact/series_radius number 4"},
                         [](ModelData& d) { d.contact_series_radius[4] = kNaN; }},
            WrongNumbers{{"TriangleIndex", "/surface/triangles number 4 is 42, expected 0 to 41"},
                         [](ModelData& d) { d.surface_triangles[4] = 42; }},
            WrongNumbers{{"NegativeTriangleIndex", "/surface/triangles number 4 is -1, expected 0 to 41"},
                         [](ModelData& d) { d.surface_triangles[4] = -1; }},
            WrongNumbers{{"ContactNode", "/contact/node number 1 is 1000, expected 0 to 41"},
                         [](ModelData& d) { d.contact_node[1] = 1000; }},
            WrongNumbers{{"ContactNodeTwice", "expected 1"},
                         [](ModelData& d) { d.contact_node[1] = d.contact_node[0]; }},
            WrongNumbers{{"PositionOfNode", "/surface/position_of_node number"},
                         [](ModelData& d) { d.position_of_node[0] = 99; }},
            WrongNumbers{{"PositionClaimedTwice", "/surface/position_of_node names"},
                         [](ModelData& d) {
                           *std::find(d.position_of_node.begin(), d.position_of_node.end(), -1) = 0;
                         }},
            WrongNumbers{{"AccessibleFlag", "/contact/accessible number 3 is 2, expected 0 or 1"},
                         [](ModelData& d) { d.contact_accessible[3] = 2; }},
            WrongNumbers{{"NearOffsetStart", "/near/offset begins with 1, expected 0"},
                         [](ModelData& d) { d.near_offset[0] = 1; }},
            WrongNumbers{{"NearOffsetFalls", "/near/offset number 2 is 0, expected at least"},
                         [](ModelData& d) { d.near_offset[2] = 0; }},
            WrongNumbers{{"NearOffsetHuge", "/near/offset number 1 is 9223372036854775807"},
                         [](ModelData& d) { d.near_offset[1] = std::numeric_limits<std::int64_t>::max(); }},
            WrongNumbers{{"NearOffsetEnd", "/near/offset ends with"},
                         [](ModelData& d) { d.near_offset.back() -= 1; }},
            WrongNumbers{{"NearNode", "/near/node number 0 is 42, expected 0 to 41"},
                         [](ModelData& d) { d.near_node[0] = 42; }},
            WrongNumbers{{"NearNodeTwice", "the one before it in block 0"},
                         [](ModelData& d) {
                           d.near_offset[1] = d.near_offset[2];  // takes over the nodes of position 1
                           d.near_node[1] = d.near_node[0];
                         }},
            WrongNumbers{{"StiffnessOfFewerPlaces", "/contact/stiffness has 126 places, expected 127"},
                         [](ModelData& d) {
                           d.contact_stiffness.resize(d.contact_stiffness.size() - 24);
                           d.edge_order = 0;
                           d.edge_offset.clear(), d.edge_node.clear(), d.edge_field.clear();
                         }},
            WrongNumbers{{"FewerEdges", "/edges/scale has 91 edges, expected 92, the places of"},
                         [](ModelData& d) {
                           const auto last = static_cast<std::size_t>(d.edge_offset.end()[-2]);
                           d.edge_offset.pop_back();
                           d.edge_node.resize(last);
                           d.edge_field.resize(3 * 16 * last);
                         }},
            WrongNumbers{
                {"EdgesOfAHigherDegree", "/edges/scale has 31 coefficients, expected those of degree 2 to"},
                [](ModelData& d) {
                  d.edge_order = 4;
                  d.edge_field.resize(3 * 31 * d.edge_node.size());
                }},
            WrongNumbers{{"EdgeOffsetFalls", "/edges/offset number 2 is 0, expected at least"},
                         [](ModelData& d) { d.edge_offset[2] = 0; }},
            WrongNumbers{{"EdgeNode", "/edges/node number 0 is 42, expected 0 to 41"},
                         [](ModelData& d) { d.edge_node[0] = 42; }},
            WrongNumbers{{"EdgeNodeTwice", "/edges/node number 1 is "},
                         [](ModelData& d) { d.edge_node[1] = d.edge_node[0]; }},
            WrongNumbers{{"InfiniteEdge", "/edges/scale number 0 is inf, expected more than 0"},
                         [](ModelData& d) { d.edge_field[0] = kInfinity; }},
            WrongNumbers{{"GreensNode", "/green/node number 3 is 42, expected 0 to 41"},
                         [](ModelData& d) { d.green_node[3] = 42; }},
            WrongNumbers{{"GreensOfALoadedNodeMissing", "/green/node lacks node"},
                         [](ModelData& d) { d.green_node[5] = d.green_node[4]; }},
            WrongNumbers{{"GreensOffsetStart", "/green/offset begins with 1, expected 0"},
                         [](ModelData& d) { d.green_offset[0] = 1; }},
            WrongNumbers{{"GreensOffsetHuge", "/green/offset number 1 is 9223372036854775807"},
                         [](ModelData& d) { d.green_offset[1] = std::numeric_limits<std::int64_t>::max(); }},
            WrongNumbers{{"GreensOffsetEnd", "/green/offset ends with"},
                         [](ModelData& d) { d.green_offset.back() -= 1; }},
            WrongNumbers{{"GreensNearNode", "/green/near_node number 0 is -1, expected 0 to 41"},
                         [](ModelData& d) { d.green_near_node[0] = -1; }},
            WrongNumbers{{"GreensNearNodeTwice", "the one before it in block 0"},
                         [](ModelData& d) {
                           d.green_offset[1] = d.green_offset[2];
                           d.green_near_node[1] = d.green_near_node[0];
                         }},
            WrongNumbers{{"Tetrahedron", "/mesh/tetrahedra number 8 is -3"},
                         [](ModelData& d) { d.mesh_tetrahedra[8] = -3; }},
            WrongNumbers{{"FixedNode", "/mesh/fixed number 0 is 43, expected 0 to 42"},
                         [](ModelData& d) { d.mesh_fixed[0] = 43; }},
            WrongNumbers{{"SurfaceNode", "/mesh/surface_node number 0 is 43"},
                         [](ModelData& d) { d.mesh_surface_node[0] = 43; }},
            WrongNumbers{{"OpenSurface", "has no neighbour across the edge"},
                         [](ModelData& d) { d.surface_triangles.resize(d.surface_triangles.size() - 3); }},
            WrongNumbers{{"TurnedTriangle", "repeats the edge"},
                         [](ModelData& d) { std::swap(d.surface_triangles[0], d.surface_triangles[1]); }},
            WrongNumbers{{"FlatTriangle", "has no area"},
                         [](ModelData& d) { d.surface_triangles[1] = d.surface_triangles[0]; }},
            WrongNumbers{{"LooseNode", "/surface/positions number 42 belongs to no triangle"},
                         [](ModelData& d) {
                           d.surface_positions.insert(d.surface_positions.end(), {1.0, 1.0, 1.0});
                           d.surface_mesh_tag.push_back(99);
                           d.position_of_node.push_back(-1);
                           d.mesh_surface_node.push_back(0);
                           d.modes_X.resize(3 * d.surface_mesh_tag.size() * 2);
                         }}),
    kCaseName);

TEST(LoadRefusesRoundedTriangles, OfNoSurfaceAndOfOneThatFillsTheMemory) {
  for (const int wrong : {0, 300'001}) {
    ModelData data = goodData();
    data.attributes.rounded_triangles = wrong;
    const TemporaryFile file("rounded.h5");
    modelfile::writeModel(file.path(), data);
    expectRefused(file.path(), "rounded_triangles is " + std::to_string(wrong) + ", expected 1 to 300000");
  }
}

}  // namespace palpate::testing
