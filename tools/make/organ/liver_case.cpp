// SPDX-License-Identifier: Apache-2.0
#include "tools/make/organ/liver_case.h"

#include <string>

#include "tools/program/write_file.h"

namespace palpate::organ {
namespace {

// Shear moduli of 1.8 and 23.4 kPa: PMC6925591, table 1.
const char* const kTissue = R"(
[material]                    # healthy liver
law = "stable-neo-hookean"
E = 5.3e3                     # Pa
nu = 0.48

[[region]]                    # a tumour, 13 times as stiff
group = "nodule"
E = 70e3
nu = 0.48

[boundary]
fixed = "fixed"
accessible = "accessible"

[model]
patch_radius = 0.006          # m; the tip of a finger-like tool of 5 mm radius

[target]
travel = 0.007                # m; how far it presses
)";

// As TOML's literal string takes it; with a quote in it, as a basic one.
std::string quoted(const std::string& text) {
  if (text.find('\'') == std::string::npos) return "'" + text + "'";
  std::string escaped;
  for (const char c : text) escaped += (c == '"' || c == '\\' ? std::string("\\") : std::string()) + c;
  return '"' + escaped + '"';
}

}  // namespace

void writeLiverCase(const std::filesystem::path& path, const std::filesystem::path& mesh) {
  const auto folder = std::filesystem::absolute(path).parent_path();
  const auto relative = std::filesystem::absolute(mesh).lexically_proximate(folder);
  program::writeFile(path, "[mesh]\nfile = " + quoted(relative.string()) +
                               "\nerror = true                  # say how stiff the mesh is\n" + kTissue);
}

}  // namespace palpate::organ
