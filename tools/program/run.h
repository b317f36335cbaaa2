// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace palpate::program {

/// Runs a program's body. An exception becomes one line "name: what" on standard error and exit code 1 (exit_code.h), of a
/// UsageError 2. Standard output that cannot be written fails a body that returned 0.
[[nodiscard]] int runProgram(const char* name, int (*body)(int argc, char** argv), int argc, char** argv);

}  // namespace palpate::program
