// SPDX-License-Identifier: Apache-2.0
#include "tools/make/solve/solve_case.h"

#include <cstddef>
#include <iostream>
#include <memory>
#include <new>
#include <stdexcept>
#include <string>
#include <vector>

#include "tools/make/solve/checkpoint_of.h"
#include "tools/make/solve/dry_run.h"
#include "tools/make/solve/provenance.h"
#include "tools/make/solve/size_warnings.h"
#include "tools/make/solve/summary.h"
#include "tools/mesh/checks.h"
#include "tools/mesh/mesh_error.h"
#include "tools/mesh/midsides.h"
#include "tools/mesh/read_mesh.h"
#include "tools/modelfile/write_model.h"
#include "tools/modelfile/write_xdmf.h"
#include "tools/program/write_file.h"
#include "tools/solver/build/build_model.h"
#include "tools/solver/build/build_model_parts.h"

namespace palpate::solve_program {

namespace {

using program::Json;

/// A bare mesh that names its accessible group means it.
void adoptGroups(solver::Case& c, const mesh::TetMesh& organ) {
  if (c.text.empty() && organ.groups.count("accessible") != 0) c.accessible = "accessible";
}

/// What can be said of the output before minutes are spent on it.
void checkOutput(const std::filesystem::path& output) {
  if (output.extension() == ".xdmf")
    throw program::UsageError("--output " + output.string() +
                              ": an .xdmf is written beside the model; name the model .h5");
  program::checkOutput("--output", output);
}

mesh::TetMesh readOrgan(const std::filesystem::path& path, const std::string& fixed) {
  mesh::TetMesh organ = mesh::readMesh(path);
  try {
    mesh::checkMesh(organ);
    (void)mesh::straighten(organ);  // what rounding of the file has moved
    if (organ.groups.count(fixed) != 0) mesh::checkHeld(organ, fixed);
  } catch (const mesh::MeshError& error) {
    throw mesh::MeshError(path.string() + ": " + error.what());
  }
  return organ;
}

/// What a solve takes; nothing is written.
Json estimated(const solver::Case& c, const mesh::TetMesh& organ, const solver::BuildOptions& build) {
  solver::BuildReport report;
  const solver::Estimate estimate = solver::estimateDisplacementSeries(c, organ, build, report);
  Json found = estimateOf(estimate, c, report);
  solver::Case chosen = c;
  if (report.travel) {
    chosen.order = report.travel->orders.fields;
    chosen.force_order = report.travel->orders.answer;
  }
  try {
    solver::requireRoom(estimate, chosen, build, build.output);
  } catch (const solver::CaseError& error) {
    found["refused"] = error.what();
  }
  return found;
}

/// All ranks know that the file is there.
void waitForFile(const solver::Ranks& ranks) {
  std::byte written{1};
  ranks.broadcast({&written, 1}, 0);
}

Json solved(Options options, const solver::Ranks& ranks) {
  const solver::Stopwatch whole;
  // 1. What to solve, and where to.
  if (options.output.empty()) options.output = "model.h5";
  checkOutput(options.output);
  solver::Case c = readCase(options);
  if (options.dry_run && c.method != solver::Method::kSeriesDisplacement)
    throw program::UsageError("--dry-run is for method series-displacement, not " + toString(c.method));
  if (options.fresh && !keepsItsWork(c))
    throw program::UsageError("--fresh is for the series methods, not " + toString(c.method));
  if (!options.scratch.empty()) program::checkOutput("--scratch", options.scratch / "series");
  // 2. The organ.
  const std::string mesh_hash = fileHash(c.mesh);  // first: a mesh that changes now is told by the next batch
  const mesh::TetMesh organ = solver::raised(c, readOrgan(c.mesh, c.fixed));
  adoptGroups(c, organ);
  const std::filesystem::path folder = std::filesystem::absolute(options.output).parent_path();
  if (options.scratch.empty()) options.scratch = folder;
  solver::BuildOptions build{options.threads, options.scratch, options.quiet, folder};
  build.ranks = &ranks;
  for (const std::string& warning : sizeWarnings(c, organ))
    if (ranks.isFirst()) std::cerr << "warning: " << warning << '\n';
  if (options.dry_run) return estimated(c, organ, build);
  // 3. The model, by the method of the case.
  solver::BuildReport report;
  const std::vector<std::string> lines = linesOf(c, mesh_hash);
  const std::unique_ptr<solver::Checkpoint> checkpoint = checkpointOf(options, c, lines, ranks);
  build.checkpoint = checkpoint.get();
  modelfile::ModelData data = solver::buildModel(c, organ, build, report);
  if (checkpoint) report.kept_seconds = checkpoint->found();
  // 4. Where it came from, and the file, by the first rank.
  if (!ranks.isFirst()) {
    waitForFile(ranks);
    if (checkpoint) checkpoint->remove();
    return {};
  }
  addProvenance(data, c, mesh_hash, report);
  const solver::Stopwatch writing;
  modelfile::writeModel(options.output, data);
  modelfile::writeXdmf(options.output);
  const double write_seconds = writing.seconds();
  waitForFile(ranks);
  if (checkpoint) checkpoint->remove();
  // 5. What came out.
  return summarize(options.output, c, data, report, write_seconds, whole.seconds());
}

}  // namespace

Json solveCase(const Options& options, const solver::Ranks& ranks) {
  try {
    return solved(options, ranks);
  } catch (const std::bad_alloc&) {
    throw std::runtime_error("out of memory; fewer modes, a smaller near_radius or a lower order need less");
  }
}

}  // namespace palpate::solve_program
