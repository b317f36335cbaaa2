// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "core/model/field_evaluation.h"
#include "core/model/meta_model.h"
#include "core/response/patch_response.h"
#include "core/response/response.h"
#include "palpate/testing/files.h"
#include "tools/modelfile/write_model.h"
#include "tools/solver/build/build_model.h"
#include "tools/solver/build/solver_setup.h"
#include "tools/solver/fem/newton.h"

namespace palpate::solver {

/// A block held at x = 0, solved, in a model file as the server loads it.
struct BlockModel {
  BlockModel(mesh::TetMesh block, Case of_block, const std::string& name = "block.h5")
      : file(name), organ(heldAtX0(std::move(block))), c(named(std::move(of_block))), setup(c, organ) {
    BuildReport report;
    data = buildModel(c, organ, {2, std::filesystem::temp_directory_path(), true}, report);
    data.attributes.provenance = "{}";
    modelfile::writeModel(file.path(), data);
  }

  struct Errors {
    double force, field;
  };

  /// Model against Newton with the patch at s.
  [[nodiscard]] Errors compare(const MetaModel& model, const ContactPoint& s, const Vec3& d) const {
    Response response;
    EXPECT_EQ(respond(model, s, d, response), ResponseStatus::kOk);
    FieldScratch scratch(model);
    std::vector<float> u(3 * surface.nodes.size());
    evaluateField(model, s, d, scratch, u);
    const NewtonResult truth =
        NewtonSolver(fe).solvePatch(makePatch(fe, surface, s, setup.patch_radius), d, {});
    double largest = 0.0;
    for (std::size_t i = 0; i < surface.nodes.size(); ++i)
      largest = std::max(largest, (Eigen::Map<const Eigen::Vector3f>(u.data() + 3 * i).cast<double>() -
                                   truth.u.segment<3>(3 * surface.nodes[i]))
                                      .norm());
    return {(response.force - truth.force).norm() / truth.force.norm(), largest / d.norm()};
  }

  palpate::testing::TemporaryFile file;
  mesh::TetMesh organ;
  Case c;
  SolverSetup setup;
  const FeModel& fe{setup.model};
  const PatchSurface& surface{setup.surface};
  modelfile::ModelData data;

 private:
  static mesh::TetMesh heldAtX0(mesh::TetMesh block) {
    for (std::int32_t node = 0; node < static_cast<std::int32_t>(block.nodes.size()); ++node)
      if (block.nodes[static_cast<std::size_t>(node)].x() < 1e-9) block.groups["fixed"].push_back(node);
    return block;
  }
  static Case named(Case c) {
    c.mesh = "block";
    return c;
  }
};

}  // namespace palpate::solver
