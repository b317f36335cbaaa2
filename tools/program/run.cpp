// SPDX-License-Identifier: Apache-2.0
#include "tools/program/run.h"

#include <iostream>
#include <new>

#include "tools/program/command_line.h"

namespace palpate::program {

int runProgram(const char* name, int (*body)(int argc, char** argv), int argc, char** argv) {
  try {
    const int code = body(argc, argv);
    if (code != 0 || std::cout.flush()) return code;
    std::cerr << name << ": standard output cannot be written\n";
  } catch (const UsageError& error) {
    std::cerr << name << ": " << error.what() << " (--help tells more)\n";
    return error.exitCode();
  } catch (const std::bad_alloc&) {
    std::cerr << name << ": out of memory\n";
  } catch (const std::exception& error) {
    std::cerr << name << ": " << error.what() << '\n';
  }
  return 1;
}

}  // namespace palpate::program
