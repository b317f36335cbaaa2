// SPDX-License-Identifier: Apache-2.0
#include "tools/make/solve/model_there.h"

#include <fstream>
#include <iterator>
#include <stdexcept>

#include "core/model/meta_model.h"
#include "tools/program/json.h"
#include "tools/program/xml.h"
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

/// @throw std::runtime_error  the .xdmf of a model that is not there leads elsewhere: a solve would replace it
void requirePictureOf(const std::filesystem::path& model) {
  const std::filesystem::path picture = std::filesystem::path(model).replace_extension(".xdmf");
  if (!std::filesystem::exists(picture)) return;
  std::ifstream in(picture);
  const std::string text{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
  const std::string name = model.filename().string();
  if (text.find(program::xmlEscaped(name) + ":/") == std::string::npos)
    throw std::runtime_error(picture.string() + " is in the way: it does not belong to " + name +
                             "; move it away");
}

}  // namespace

std::optional<std::string> reasonToSolve(const std::filesystem::path& model,
                                         const std::vector<std::string>& solve) {
  if (!std::filesystem::exists(model)) {
    requirePictureOf(model);
    return "";
  }
  const auto before = linesIn(MetaModel::load(model).attributes().provenance);
  if (!before)
    throw std::runtime_error(model.string() +
                             " is in the way: it is not as palpate-solve makes it of a case; move it away");
  if (*before == solve) return std::nullopt;
  return solver::differenceOf(solve, *before);
}

}  // namespace palpate::solve_program
