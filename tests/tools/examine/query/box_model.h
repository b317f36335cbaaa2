// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <functional>
#include <string>

#include "palpate/testing/files.h"
#include "tools/examine/query/full_solution.h"
#include "tools/examine/query/query_error.h"
#include "tools/mesh/box_mesh.h"
#include "tools/modelfile/read_volume_mesh.h"
#include "tools/modelfile/write_model.h"
#include "tools/program/exit_code.h"
#include "tools/solver/build/build_model.h"

namespace palpate::query::test {

using palpate::testing::contentOf;
using palpate::testing::TemporaryFolder;

/// Cells of 20 mm, 6 x 4 x 3 nodes, held at x = 0, to be touched from x = 40 mm on. Its numbers have gaps and
/// run backwards, so that a number taken for an index is found out.
struct BoxMesh {
  static constexpr int kNx = 6, kNy = 4, kNz = 3;
  static int node(int i, int j, int k) { return i + kNx * (j + kNy * k); }
  static std::int64_t number(int i, int j, int k) { return 1000 - 7 * node(i, j, k); }

  static mesh::TetMesh make() {
    mesh::TetMesh box = mesh::makeBox({0.1, 0.06, 0.04}, {kNx, kNy, kNz});
    box.groups.clear();
    for (int i = 0; i < static_cast<int>(box.nodes.size()); ++i) {
      box.node_tags[static_cast<std::size_t>(i)] = 1000 - 7 * i;
      if (i % kNx == 0) box.groups["fixed"].push_back(i);
      if (i % kNx >= 2) box.groups["accessible"].push_back(i);
      if (i < kNx * kNy) box.groups["bed"].push_back(i);
    }
    for (std::size_t t = 0; t < box.tetrahedra.size(); ++t)
      box.tetrahedron_tags[t] = 5000 - 2 * static_cast<std::int64_t>(t);
    for (std::size_t t = 0; t < box.tetrahedra.size(); ++t) {
      Eigen::Vector3d middle = Eigen::Vector3d::Zero();
      for (const std::int32_t node : box.tetrahedra[t])
        middle += 0.25 * box.nodes[static_cast<std::size_t>(node)];
      if (middle.x() > 0.04 && middle.x() < 0.08)
        box.regions["nodule"].push_back(static_cast<std::int32_t>(t));
    }
    return box;
  }
};

/// What the box is made of.
struct BoxCase {
  enum Kind { kPlain, kRegionAndSprings };
  static constexpr double kBed = 2e5;  ///< N/m^3
};

/// The model of the box. Its near field covers the box whole: what the modes miss is all in there.
/// @param scratch  folder for the solver's  @param stiffer  what E of all its parts and the springs are multiplied by
inline modelfile::ModelData boxModelData(const std::filesystem::path& scratch,
                                         const std::string& law = "stvk", int element_order = 1,
                                         BoxCase::Kind kind = BoxCase::kPlain, double stiffer = 1.0) {
  solver::Case c;
  c.mesh = "box";
  c.accessible = "accessible";
  c.law = law;
  c.element_order = element_order;
  c.E = stiffer * 1e5;
  c.nu = 0.4;
  if (kind == BoxCase::kRegionAndSprings) {
    c.regions.push_back({"nodule", stiffer * 5e5, 0.3, "stable-neo-hookean", "case"});
    c.springs.push_back({"bed", stiffer * BoxCase::kBed, "case"});
  }
  c.patch_radius = 0.012;
  c.modes = 10;
  c.near_radius = 1.0;
  c.sweeps = 2;
  solver::BuildReport report;
  modelfile::ModelData data =
      solver::buildModel(c, solver::raised(c, BoxMesh::make()), {1, scratch, true}, report);
  data.attributes.provenance = "{}";
  return data;
}

inline void writeBoxModel(const std::filesystem::path& path, const std::string& law = "stvk",
                          int element_order = 1, BoxCase::Kind kind = BoxCase::kPlain, double stiffer = 1.0) {
  modelfile::writeModel(path, boxModelData(path.parent_path(), law, element_order, kind, stiffer));
}

/// The model of the box, loaded, and its full problem.
struct BoxModel {
  explicit BoxModel(std::string of_law = "stvk", int order = 1, BoxCase::Kind of_kind = BoxCase::kPlain)
      : law(std::move(of_law)), element_order(order), kind(of_kind) {}

  std::string law;
  int element_order;
  BoxCase::Kind kind;
  TemporaryFolder folder;
  std::filesystem::path path{(writeBoxModel(folder / "box.h5", law, element_order, kind), folder / "box.h5")};
  MetaModel model{MetaModel::load(path)};
  Organ organ{organOf(model, modelfile::readVolumeMesh(path))};

  [[nodiscard]] FullSolution solve(const Anchor& anchor, const Vec3& d) const {
    return solveFully(organ, anchor, model.attributes().patch_radius, d, 1);
  }
};

/// The message of the QueryError or UsageError that `work` throws; empty if it throws none.
inline std::string errorOf(const std::function<void()>& work) {
  try {
    work();
  } catch (const QueryError& error) {
    return error.what();
  } catch (const program::UsageError& error) {
    return error.what();
  }
  return {};
}

}  // namespace palpate::query::test
