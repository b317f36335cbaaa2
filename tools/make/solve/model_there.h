// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace palpate::solve_program {

/// Why a case has to be solved although there may be a model of it.
/// @param solve  linesOf() the case as it is now
/// @return none: the model belongs to it; empty: there is no model; else what has changed since
/// @throw std::runtime_error  the file is damaged, or palpate-solve did not make it of a case; or there is no model, but an
///         .xdmf that is not of it: they are nobody's to replace
[[nodiscard]] std::optional<std::string> reasonToSolve(const std::filesystem::path& model,
                                                       const std::vector<std::string>& solve);

}  // namespace palpate::solve_program
