// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

#include "tools/make/solve/options.h"
#include "tools/program/json.h"

namespace palpate::solve_program {

/// What has become of a case.
enum class CaseState : std::uint8_t {
  kWaiting,
  kSolved,
  kEstimated,  ///< of a dry run
  kThere,      ///< its model was there
  kElsewhere,  ///< another program solves it now
  kFailed,
};

/// One case of a batch.
struct BatchCase {
  Options options;  ///< of its solve: input, output and scratch are given
  CaseState state{CaseState::kWaiting};
  double work{0.0};       ///< about how much it is beside others; 0 where its mesh is not known
  std::string again{};    ///< what has changed since its model was made; empty: there was none
  std::string error{};    ///< why it failed
  program::Json found{};  ///< of a solve or a dry run

  [[nodiscard]] std::string name() const { return options.input.filename().string(); }
};

/// Reads a case and says whether its model is there: its state becomes kThere or kFailed, or stays.
void look(BatchCase& one);

/// Solves it, or says what that would take, in a process of its own, unless its model has come to be there or another program is at it.
void solve(BatchCase& one);

}  // namespace palpate::solve_program
