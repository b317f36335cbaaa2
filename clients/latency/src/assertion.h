// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "tools/program/json.h"

namespace palpate::latency {

/// A bound on one figure of the JSON report, as in "pose_to_force_us.p99<500" or "lost==0".
struct Assertion {
  enum class Relation { kLess, kAtMost, kEqual, kUnequal, kAtLeast, kMore };
  std::string text;  ///< as it was written
  std::string path;  ///< keys joined by dots
  Relation relation{Relation::kLess};
  double bound{0.0};  ///< true and false are 1 and 0
};

/// @param[in] text   PATH RELATION NUMBER, with or without blanks; the relations are < <= == != >= >
/// @param[in] shape  a report, of whatever was or was not measured: it has the keys
/// @throw program::ValueError naming what does not read, and for a path that no report has, the paths near it
[[nodiscard]] Assertion parseAssertion(const std::string& text, const program::Json& shape);

/// What an assertion made of a report.
struct Outcome {
  Assertion assertion;
  bool held{false};
  std::string found;  ///< the figure, or that it was not measured; never empty
};

/// A figure that was not measured (null, or a quantile of no values) holds no assertion.
[[nodiscard]] Outcome judge(const Assertion& assertion, const program::Json& report);

/// The same of several tools: it holds where it holds for each. Else the first for which it does not is named.
/// @param[in] tools  reports with their `tool_id`, at least one
[[nodiscard]] Outcome judgeEach(const Assertion& assertion, const std::vector<program::Json>& tools);

/// "assertion failed: pose_to_force_us.p99<500: it is 812.3"
[[nodiscard]] std::string failureLine(const Outcome& outcome);

/// JUnit XML: one test case for each assertion. @param[in] seconds  of the measurement
[[nodiscard]] std::string junitOf(const std::vector<Outcome>& outcomes, double seconds);

}  // namespace palpate::latency
