// SPDX-License-Identifier: Apache-2.0
#include "tools/program/run.h"

#include <csignal>
#include <iostream>
#include <new>

#include "tools/program/exit_code.h"

namespace palpate::program {

int runProgram(const char* name, int (*body)(int argc, char** argv), int argc, char** argv) {
  // Inherited as ignored it would hide how the process ends that parses a model (core/data/ask_reader.h).
  std::signal(SIGCHLD, SIG_DFL);
  try {
    const int code = body(argc, argv);
    if (code != kDone || std::cout.flush()) return code;
    std::cerr << name << ": standard output cannot be written\n";
  } catch (const UsageError& error) {
    std::cerr << name << ": " << error.what() << '\n';
    return kUsage;
  } catch (const std::bad_alloc&) {
    std::cerr << name << ": out of memory\n";
  } catch (const std::exception& error) {
    std::cerr << name << ": " << error.what() << '\n';
  }
  return kFailed;
}

}  // namespace palpate::program
