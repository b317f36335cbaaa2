// SPDX-License-Identifier: Apache-2.0
#include "tools/make/solve/provenance.h"

#include <chrono>
#include <ctime>
#include <fstream>
#include <span>
#include <stdexcept>

#include "core/data/sha256.h"
#include "tools/make/solve/summary.h"
#include "tools/solver/build/case_lines.h"

namespace palpate::solve_program {

namespace {

std::string utcNow() {
  const std::time_t now = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
  char text[32];
  std::tm utc{};
  gmtime_r(&now, &utc);
  std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", &utc);
  return text;
}

}  // namespace

std::string fileHash(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  if (!in) throw std::runtime_error(path.string() + ": cannot be opened for reading");
  Sha256 hash;
  char block[1 << 16];
  while (in.read(block, sizeof block) || in.gcount() > 0)
    hash.add(std::as_bytes(std::span<const char>(block, static_cast<std::size_t>(in.gcount()))));
  return hash.finish().hex();
}

std::vector<std::string> linesOf(const solver::Case& c, const std::string& mesh_hash) {
  std::vector<std::string> lines = solver::linesOf(c);
  lines.push_back("mesh = SHA-256 " + mesh_hash);
  return lines;
}

void addProvenance(modelfile::ModelData& data, const solver::Case& c, const std::string& mesh_hash,
                   const solver::BuildReport& report) {
  program::Json provenance{{"program", "palpate-solve"},
                           {"version", PALPATE_VERSION},
                           {"created", utcNow()},
                           {"mesh", c.mesh.filename().string()},
                           {"mesh_hash", mesh_hash},
                           {"solve", linesOf(c, mesh_hash)},
                           {"case", c.text},
                           {"fixed", c.fixed},
                           {"accessible", c.accessible.value_or("")},
                           {"method", toString(c.method)},
                           {"seconds", stages(c.method, report)}};
  if (report.mesh_error) provenance["mesh_error"] = meshErrorOf(report);
  if (report.travel) provenance["travel"] = report.travel->travel;
  if (c.method == solver::Method::kSeriesDisplacement) {
    provenance["force_error"] = c.forceErrorOrDefault();
    provenance["field_error"] = c.fieldErrorOrDefault();
  }
  if (report.size) {
    provenance["target"] = "handheld";
    provenance["size"] = sizeOf(report);
  }
  if (report.fit_errors.empty()) {
    provenance["load"] = loadOf(c, report);
    provenance["pairs"] = report.greedy_pairs;
    provenance["residual"] = report.residual;
    provenance["recompression_error"] = report.truncation;
  } else {
    provenance["sweeps"] = c.sweepsOrDefault();
    provenance["fit_errors"] = report.fit_errors;
    if (c.method == solver::Method::kSeriesDisplacement && !report.size) {
      provenance["fit_p95"] = report.fit_p95;
      provenance["fit_max"] = report.fit_max;
    }
  }
  data.attributes.provenance = provenance.dump();
}

}  // namespace palpate::solve_program
