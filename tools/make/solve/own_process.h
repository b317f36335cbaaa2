// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "tools/program/json.h"

namespace palpate::solve_program {

/// Runs work in a process of its own and waits for its end: its memory goes with it, and what kills it does not reach this one. It
/// is killed when this process ends. Only where no other thread of this process is at work; the pool of OpenBLAS, which is there
/// once that is loaded, is ended by its own fork handler.
/// @param work  what it throws ends the process
/// @return what work returned  @throw std::runtime_error  the process was killed, threw, or cannot be started
[[nodiscard]] program::Json inOwnProcess(const std::function<program::Json()>& work);

}  // namespace palpate::solve_program
