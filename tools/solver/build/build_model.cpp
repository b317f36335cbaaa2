// SPDX-License-Identifier: Apache-2.0
#include "tools/solver/build/build_model.h"

#include <string>
#include <utility>

#include "tools/solver/base/parallel.h"
#include "tools/solver/build/build_model_pgd.h"
#include "tools/solver/build/displacement_series.h"
#include "tools/solver/build/force_series.h"
#include "tools/solver/fem/block_kernel.h"

namespace palpate::solver {

modelfile::ModelData buildModel(const Case& c, const mesh::TetMesh& mesh, const BuildOptions& options,
                                BuildReport& report) {
  checkCase(c);
  const bool series = c.method == Method::kSeriesDisplacement || c.method == Method::kSeriesForce;
  if (options.ranks->size() > 1 && (!series || c.handheld()))
    throw CaseError((c.handheld() ? std::string("target handheld") : "method " + toString(c.method)) +
                    " is solved by one process, not by " + std::to_string(options.ranks->size()));
  switch (c.method) {
    case Method::kSeriesDisplacement:
      return buildDisplacementSeries(c, mesh, options, report);
    case Method::kSeriesForce: {
      const FitSize size{c.modesOrDefault(), c.sweepsOrDefault()};
      return std::move(buildForceSeries(c, mesh, options, {&size, 1}, report).front());
    }
    case Method::kPgdLinear:
    case Method::kPgdExplicit:
    case Method::kPgdEuler:
      return buildPgd(c, mesh, options, report);
  }
  throw CaseError("method is not known");
}

std::string arithmetic() {
  return blasVersion() + ", kernels " + blockKernel();
}

}  // namespace palpate::solver
