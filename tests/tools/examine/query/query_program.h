// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "box_model.h"
#include "load_models.h"
#include "palpate/testing/run_program.h"

namespace palpate::query::test {

using palpate::testing::expectOneLineError;
using palpate::testing::ProgramResult;
using palpate::testing::runProgram;

/// Asks palpate-query about a model. @param model  a BoxModel or a LoadModel
template <typename Model>
ProgramResult query(const Model& model, std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), model.path.string());
  return runProgram("palpate-query", arguments);
}

inline Vec3 vectorOf(const nlohmann::json& list) {
  EXPECT_EQ(list.size(), 3U);
  return {list.at(0).get<double>(), list.at(1).get<double>(), list.at(2).get<double>()};
}

}  // namespace palpate::query::test
