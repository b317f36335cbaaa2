// SPDX-License-Identifier: Apache-2.0
#include <charconv>

#include "tools/make/organ/fill_file.h"
#include "tools/make/organ/repair/repair_surface.h"
#include "tools/mesh/mesh_error.h"
#include "tools/mesh/read_surface.h"
#include "tools/mesh/surface_defects.h"
#include "tools/program/exit_code.h"
#include "tools/program/printed.h"

namespace palpate::organ {
namespace {

using mesh::MeshError;
using mesh::Solid;

std::string inWords(double volume, const Eigen::Vector3d& middle) {
  return program::printed("%.4g m^3 at (%.4g %.4g %.4g) m", volume, middle.x(), middle.y(), middle.z());
}

std::string listed(const std::vector<Solid>& solids) {
  constexpr std::size_t kMost = 6;
  std::string words;
  for (std::size_t i = 0; i < std::min(solids.size(), kMost); ++i)
    words += (i > 0 ? "; " : "") + std::to_string(i + 1) + ": " + inWords(solids[i].volume, solids[i].middle);
  return words + (solids.size() > kMost ? "; ..." : "");
}

// The number of the part behind --part, from 0.
std::size_t chosen(const std::string& part, const std::vector<Solid>& solids) {
  if (part == "largest") return 0;
  std::size_t number = 0;
  const auto [end, error] = std::from_chars(part.data(), part.data() + part.size(), number);
  if (error == std::errc{} && end == part.data() + part.size() && number >= 1 && number <= solids.size())
    return number - 1;
  throw program::UsageError("--part " + part + ": expected largest or a number from 1 to " +
                            std::to_string(solids.size()) + ": " + listed(solids));
}

Solid onePart(std::vector<Solid> solids, const ImportOptions& options, std::vector<std::string>& notes) {
  if (solids.size() > 1 && !options.part) {
    throw MeshError("the surface has " + std::to_string(solids.size()) +
                    " parts that are not joined, of which --part largest or " +
                    "--part N takes one: " + listed(solids));
  }
  const std::size_t number = options.part ? chosen(*options.part, solids) : 0;
  if (solids.size() > 1)
    notes.push_back("part " + std::to_string(number + 1) + " of " + std::to_string(solids.size()) +
                    " is taken: " + listed(solids));
  Solid solid = std::move(solids[number]);
  for (const auto& cavity : solid.cavities)
    notes.push_back("the organ has a cavity: " + inWords(cavity.volume, cavity.middle));
  return solid;
}

mesh::TriangleSurface repaired(const mesh::TriangleSurface& surface, const ImportOptions& options) {
  Repairs repairs;
  mesh::TriangleSurface whole = repairSurface(surface, repairs);
  for (const auto& line : repairs.inWords()) options.say("repair           " + line);
  return whole;
}

// Before the minutes that filling takes.
void checkGroups(const mesh::TriangleSurface& surface, const FixedRules& rules) {
  for (const FixedRule& rule : rules)
    if (rule.kind == FixedRule::Kind::kGroup && !surface.groups.contains(rule.group))
      refuseUnknownGroup(rule.group, surface.groups);
}

}  // namespace

FileSolid readSolid(const std::filesystem::path& path, const ImportOptions& options,
                    std::vector<std::string>& notes) {
  mesh::TriangleSurface surface = mesh::readSurface(path);
  for (auto& x : surface.vertices) x *= options.scale;
  checkGroups(surface, options.fixed);
  FileSolid read;
  if (!surface.groups.empty()) read.painted = surface;
  if (options.repair) {
    surface = repaired(surface, options);
  } else if (const auto defects = mesh::surfaceDefects(surface); !defects.empty()) {
    throw MeshError("the surface bounds no solid; --repair repairs it and says how. " +
                    mesh::inWords(defects));
  }
  read.solid = onePart(mesh::solidsOf(surface), options, notes);
  return read;
}

}  // namespace palpate::organ
