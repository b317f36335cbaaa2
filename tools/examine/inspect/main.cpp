// SPDX-License-Identifier: Apache-2.0
// palpate-inspect: what a model file holds.
#include <iostream>

#include "tools/examine/inspect/describe.h"
#include "tools/program/command_line.h"
#include "tools/program/run.h"

namespace palpate::inspect {
namespace {

int body(int argc, char** argv) {
  program::CommandLine line("palpate-inspect",
                            "Checks a model file and says what it holds. Lengths in m, E in Pa.");
  std::string path;
  bool json = false;
  line.options().add("model", &path, "model file (.h5)").required();
  line.options().flag("--json", &json, "print one JSON object on standard output");
  line.options().example("palpate-inspect liver.h5");
  if (!line.read(argc, argv)) return program::kDone;
  const program::Json description = describe(MetaModel::load(path));
  std::cout << (json ? description.dump(2, program::Keys::kAsWritten) + "\n" : table(description));
  return program::kDone;
}

}  // namespace
}  // namespace palpate::inspect

int main(int argc, char** argv) {
  return palpate::program::runProgram("palpate-inspect", &palpate::inspect::body, argc, argv);
}
