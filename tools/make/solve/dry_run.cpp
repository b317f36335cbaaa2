// SPDX-License-Identifier: Apache-2.0
#include "tools/make/solve/dry_run.h"

#include <cstdio>

namespace palpate::solve_program {

using program::Json;

Json estimateOf(const solver::Estimate& e, const solver::Case& c, const solver::BuildReport& report) {
  const solver::SeriesOrders orders = report.travel ? report.travel->orders : c.orders();
  return {{"dry_run", true},
          {"order", orders.fields},
          {"force_order", orders.answer},
          {"modes", e.modes},
          {"seconds",
           {{"factor", e.factor},
            {"mesh_error", e.mesh_error},
            {"orders", e.orders},
            {"series", e.series + e.edges},
            {"fit", e.fit},
            {"write", e.write},
            {"total", e.seconds()}}},
          {"probe_seconds", e.probe},
          {"memory_bytes", e.memory},
          {"scratch_bytes", e.scratch},
          {"file_bytes", e.file}};
}

void printEstimate(const Json& e) {
  const Json& s = e["seconds"];
  std::printf("a solve takes about %.0f s: series %.0f s, fit %.0f s with %d modes, all else %.0f s\n",
              s["total"].get<double>(), s["series"].get<double>(), s["fit"].get<double>(),
              e["modes"].get<int>(),
              s["total"].get<double>() - s["series"].get<double>() - s["fit"].get<double>());
  std::printf("fields of degree %d, force of degree %d\n", e["order"].get<int>(),
              e["force_order"].get<int>());
  std::printf("memory %.0f MiB, scratch %.0f MB, model file %.0f MB\n",
              e["memory_bytes"].get<double>() / 1048576.0, 1e-6 * e["scratch_bytes"].get<double>(),
              1e-6 * e["file_bytes"].get<double>());
}

}  // namespace palpate::solve_program
