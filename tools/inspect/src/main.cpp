// SPDX-License-Identifier: Apache-2.0
// palpate-inspect: what a model file holds.
#include <CLI/CLI.hpp>
#include <exception>
#include <iostream>

#include "describe.h"

int main(int argc, char** argv) {
  CLI::App app("Checks a model file and says what it holds. Lengths in m, E in Pa.");
  app.set_version_flag("--version", PALPATE_VERSION);
  std::string path;
  bool json = false;
  app.add_option("model", path, "model file (.h5)")->required();
  app.add_flag("--json", json, "print one JSON object on standard output");
  CLI11_PARSE(app, argc, argv);
  try {
    const auto description = palpate::inspect::describe(palpate::MetaModel::load(path));
    // A model's texts may hold bytes that are no UTF-8: shown as replacement characters, not refused.
    constexpr auto kReplace = nlohmann::ordered_json::error_handler_t::replace;
    std::cout << (json ? description.dump(2, ' ', false, kReplace) + "\n"
                       : palpate::inspect::table(description));
  } catch (const std::exception& error) {
    std::cerr << "palpate-inspect: " << error.what() << '\n';
    return 1;
  }
  return std::cout.flush() ? 0 : 1;
}
