// SPDX-License-Identifier: Apache-2.0
// Files that are made to cost much more time than their size.
#include <gtest/gtest.h>
#include <hdf5.h>

#include <cmath>
#include <cstring>
#include <fstream>
#include <functional>
#include <numbers>

#include "../load_case.h"

namespace palpate::testing {

namespace {

using modelfile::ModelData;

void expectRefusedData(const ModelData& data, const std::string& expected) {
  const TemporaryFile file("hostile.h5");
  modelfile::writeModel(file.path(), data);
  expectRefused(file.path(), expected);
}

/// Two tips over and under a ring of n nodes: each tip has n triangles.
ModelData doubleCone(int n) {
  ModelData d;
  d.attributes = {"stvk", "{}", 1e3, 0.3, 1, 1e-6, 0.0, 0.005};
  const int Ns = n + 2;
  for (int i = 0; i < n; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / n;
    d.surface_positions.insert(d.surface_positions.end(),
                               {0.1 * std::cos(angle), 0.1 * std::sin(angle), 0.0});
    d.surface_triangles.insert(d.surface_triangles.end(), {i, (i + 1) % n, n, (i + 1) % n, i, n + 1});
  }
  d.surface_positions.insert(d.surface_positions.end(), {0.0, 0.0, 0.1, 0.0, 0.0, -0.1});
  for (int i = 0; i < Ns; ++i) {
    d.surface_mesh_tag.push_back(i + 1);
    d.position_of_node.push_back(i);
    d.contact_node.push_back(i);
    d.mesh_surface_node.push_back(i);
  }
  d.contact_accessible.assign(d.contact_node.size(), 1);
  d.contact_domain_radius.assign(d.contact_node.size(), 0.001);
  d.contact_series_radius = d.contact_domain_radius;
  d.contact_force.assign(9 * d.contact_node.size(), 1.0);
  d.green_offset.assign(1, 0);
  d.near_offset.assign(d.contact_node.size() + 1, 0);
  d.mesh_nodes = d.surface_positions;
  d.mesh_node_tag = d.surface_mesh_tag;
  return d;
}

}  // namespace

TEST(LoadHostile, ANodeOfManyTrianglesIsRefused) {
  expectRefusedData(doubleCone(100'000),
                    "/surface/triangles has 100000 triangles at node 100000, expected at most 1024");
}

TEST(LoadHostile, LevelsTimesPositionsAreLimited) {
  ModelData data = syntheticModel({.subdivisions = 5,
                                   .modes = 0,
                                   .parameters = Parameters::kLevel,
                                   .level_functions = 1,
                                   .level_steps = 100'000});
  expectRefusedData(data, "/levels/Z has 100001 numbers for each of 8681 positions, expected at most");
}

TEST(LoadHostile, APatchOverFixedNodesIsLimitedToo) {
  ModelData data = syntheticModel({.subdivisions = 5, .modes = 0, .near_radius = 1e-6});
  data.attributes.patch_radius = 10.0;
  for (int node = 2; node < 10'242; ++node) data.mesh_fixed.push_back(node);
  expectRefusedData(data, "expected one of patches with at most 2048 nodes, found 10242");
}

TEST(LoadHostile, ModesTimesNodesInPatchesAreLimited) {
  ModelData data = syntheticModel({.subdivisions = 4, .order = 1, .modes = 1600, .near_radius = 1e-6});
  data.attributes.patch_radius = 0.03;
  expectRefusedData(data,
                    "expected one of patches with at most 2500000 nodes together for 1600 modes, found");
}

/// HDF5 looks up each name among all of them.
TEST(LoadHostile, HundredsOfAttributesAndLinksAreReadOver) {
  const TemporaryFile path("many.h5");
  modelfile::writeModel(path.path(), goodData());
  {
    const Hdf5Handle file = openForSpoiling(path.path(), 1);
    const Hdf5Handle space(H5Screate(H5S_SCALAR), H5Sclose);
    for (int i = 0; i < 500; ++i) {
      const std::string name = "more" + std::to_string(i);
      const Hdf5Handle attribute(
          H5Acreate2(file.get(), name.c_str(), H5T_STD_I8LE, space.get(), H5P_DEFAULT, H5P_DEFAULT),
          H5Aclose);
      ASSERT_TRUE(attribute.valid()) << i;
      ASSERT_GE(H5Lcreate_soft("/nowhere", file.get(), name.c_str(), H5P_DEFAULT, H5P_DEFAULT), 0) << i;
    }
  }
  EXPECT_EQ(complaint(path.path()), "");
}

namespace {

/// What loading says about a file that `spoil` changed, byte by byte.
void expectRefusedBytes(const std::function<void(std::string&)>& spoil, const std::string& expected) {
  const TemporaryFile file("bytes.h5");
  modelfile::writeModel(file.path(), goodData());
  std::string bytes = contentOf(file.path());
  spoil(bytes);
  std::ofstream(file.path(), std::ios::binary) << bytes;
  expectRefused(file.path(), expected);
}

template <class T>
void putNumber(std::string& bytes, std::size_t at, T value) {
  std::memcpy(bytes.data() + at, &value, sizeof value);
}

}  // namespace

/// HDF5 goes down such a tree until its stack ends.
TEST(LoadHostile, ATreeOfNamesThatIsItsOwnChildIsRefused) {
  const auto spoil = [](std::string& bytes) {
    const std::size_t tree = bytes.find("TREE");  // signature, type, level, entries; two siblings; key, child
    putNumber(bytes, tree + 5, std::uint8_t{1});
    putNumber(bytes, tree + 32, std::uint64_t{tree});
  };
  expectRefusedBytes(spoil, "the process that parses it ended");
}

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)  // no limit of addresses there
/// HDF5 gets as much memory as a text says that it is long.
TEST(LoadHostile, ATextThatClaimsGigabytesIsRefused) {
  const auto spoil = [](std::string& bytes) {
    const std::size_t heap = bytes.find("GCOL");
    const std::string address(reinterpret_cast<const char*>(&heap), sizeof heap);
    putNumber(bytes, bytes.find(address) - 4, std::uint32_t{0xF0000000});  // the length stands before it
  };
  expectRefusedBytes(spoil, "attribute format is no readable text");
}
#endif

}  // namespace palpate::testing
