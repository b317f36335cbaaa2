// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "palpate/testing/run_program.h"
#include "palpate/testing/server_process.h"
#include "palpate/testing/synthetic_model.h"
#include "palpate/testing/test_domain.h"

namespace palpate::testing {

using nlohmann::json;

/// palpate-server on a model known in closed form, on a domain of the test's own.
struct Running {
  TemporaryFile model{"clients-e2e.h5"};
  std::string domain{std::to_string(exclusiveDomain())};
  std::unique_ptr<ServerProcess> process;

  // By default the model's own force, no coupling.
  explicit Running(const std::vector<std::string>& options = {"--device", "custom", "--friction", "inf"}) {
    writeSyntheticModel(model.path());
    std::vector<std::string> arguments{"--model", model.path().string(), "--domain", domain};
    arguments.insert(arguments.end(), options.begin(), options.end());
    process = std::make_unique<ServerProcess>(arguments);
  }
  [[nodiscard]] json run(const std::string& program, std::vector<std::string> arguments) const {
    arguments.insert(arguments.end(), {"--json", "--wait", "30", "--domain", domain});
    const auto result = runProgram(program, arguments);
    EXPECT_EQ(result.exit_code, 0) << program << ": " << result.err;
    return result.exit_code == 0 ? json::parse(result.out) : json();
  }
};

}  // namespace palpate::testing
