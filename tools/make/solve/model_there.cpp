// SPDX-License-Identifier: Apache-2.0
#include "tools/make/solve/model_there.h"

#include <stdexcept>

#include "core/model/meta_model.h"
#include "tools/program/json.h"
#include "tools/solver/base/checkpoint.h"

namespace palpate::solve_program {

namespace {

using program::Json;

/// The lines that a model was solved by; none: another program made or changed it.
std::optional<std::vector<std::string>> linesIn(const std::string& provenance) {
  const auto made = Json::read(provenance);
  const Json* const solve = made ? made->find("solve") : nullptr;
  if (solve == nullptr || !solve->isArray() || made->contains("fitted")) return std::nullopt;
  std::vector<std::string> lines;
  for (const Json& line : *solve) {
    if (!line.isString()) return std::nullopt;
    lines.push_back(line.text());
  }
  return lines;
}

}  // namespace

std::optional<std::string> reasonToSolve(const std::filesystem::path& model,
                                         const std::vector<std::string>& solve) {
  if (!std::filesystem::exists(model)) return "";
  const auto before = linesIn(MetaModel::load(model).attributes().provenance);
  if (!before)
    throw std::runtime_error(model.string() +
                             " is in the way: it is not as palpate-solve makes it of a case; move it away");
  if (*before == solve) return std::nullopt;
  return solver::differenceOf(solve, *before);
}

}  // namespace palpate::solve_program
