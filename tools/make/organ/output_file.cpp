// SPDX-License-Identifier: Apache-2.0
#include "tools/make/organ/output_file.h"

#include "tools/mesh/write_msh.h"
#include "tools/mesh/write_vtk.h"
#include "tools/program/command_line.h"
#include "tools/program/write_file.h"

namespace palpate::organ {

void checkOutput(const std::filesystem::path& file) {
  const std::string ending = file.extension().string();
  if (ending != ".msh" && ending != ".vtk") {
    throw program::UsageError("--output " + file.string() +
                              ": the ending says the format, .msh (Gmsh) or .vtk, and " +
                              (ending.empty() ? "there is none" : "is " + ending));
  }
  program::checkOutput("--output", file);
}

void writeOrgan(const std::filesystem::path& file, const mesh::TetMesh& mesh,
                const mesh::BoundarySurface& boundary, std::vector<std::string>& notes) {
  if (file.extension() == ".msh") {
    mesh::writeMsh(file, mesh, boundary);
    return;
  }
  mesh::writeVtk(file, mesh);
  notes.emplace_back("a .vtk file keeps no groups: palpate-solve needs a .msh to know what is fixed");
}

}  // namespace palpate::organ
