// SPDX-License-Identifier: Apache-2.0
#include "provenance.h"

#include <chrono>
#include <cstdint>
#include <ctime>
#include <fstream>

#include "summary.h"

namespace palpate::solve {

namespace {

/// FNV-1a, 64 bit: tells two models or meshes apart; it is no protection against a forger.
class Hash {
 public:
  void add(const void* data, std::size_t bytes) {
    const auto* byte = static_cast<const unsigned char*>(data);
    for (std::size_t i = 0; i < bytes; ++i) value_ = (value_ ^ byte[i]) * 0x100000001b3ULL;
  }
  template <typename T>
  void add(const std::vector<T>& list) {
    add(list.data(), list.size() * sizeof(T));
  }
  [[nodiscard]] std::string text() const {
    char hex[17];
    std::snprintf(hex, sizeof hex, "%016llx", static_cast<unsigned long long>(value_));
    return hex;
  }

 private:
  std::uint64_t value_{0xcbf29ce484222325ULL};
};

std::string fileHash(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  Hash hash;
  char block[1 << 16];
  while (in.read(block, sizeof block) || in.gcount() > 0)
    hash.add(block, static_cast<std::size_t>(in.gcount()));
  return hash.text();
}

std::string utcNow() {
  const std::time_t now = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
  char text[32];
  std::tm utc{};
  gmtime_r(&now, &utc);
  std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", &utc);
  return text;
}

}  // namespace

void addProvenance(modelfile::ModelData& data, const offline::Case& c, const offline::BuildReport& report,
                   const modelfile::StorageReport& storage) {
  Hash hash;
  hash.add(data.surface_positions);
  hash.add(data.surface_triangles);
  hash.add(data.contact_force);
  hash.add(data.contact_displacement);
  hash.add(data.contact_domain_radius);
  hash.add(data.levels_Z);
  hash.add(data.modes_X);
  hash.add(data.modes_Y);
  hash.add(data.modes_packed.X16);
  hash.add(data.modes_packed.X8);
  hash.add(data.modes_packed.scale);
  hash.add(data.modes_packed.kinds);
  hash.add(data.near_field);
  data.attributes.model_id = hash.text();
  program::Json provenance{{"program", "palpate-solve"},
                           {"version", PALPATE_VERSION},
                           {"created", utcNow()},
                           {"mesh", c.mesh.filename().string()},
                           {"mesh_hash", fileHash(c.mesh)},
                           {"case", c.text},
                           {"fixed", c.fixed},
                           {"accessible", c.accessible.value_or("")},
                           {"method", toString(c.method)},
                           {"storage", toJson(storage)},
                           {"seconds", stages(c.method, report)}};
  if (report.fit_errors.empty()) {
    provenance["load"] = loadOf(c, report);
    provenance["pairs"] = report.greedy_pairs;
    provenance["residual"] = report.residual;
    provenance["recompression_error"] = report.truncation;
  } else {
    provenance["sweeps"] = c.sweepsOrDefault();
    provenance["fit_errors"] = report.fit_errors;
  }
  data.attributes.provenance = provenance.dump();
}

}  // namespace palpate::solve
