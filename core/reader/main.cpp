// SPDX-License-Identifier: Apache-2.0
// palpate-read-model: parses one model file for a program that does not (core/data/ask_reader.h). Standard input is the sealed
// copy of the file, standard output takes the answer.
#include <hdf5.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sysexits.h>
#include <unistd.h>

#include <cstdio>
#include <exception>
#include <new>
#include <span>
#include <string>

#include "core/data/load_error.h"
#include "core/data/model_reader.h"
#include "core/reader/hdf5_reader.h"
#include "core/reader/sandbox.h"

namespace palpate {
namespace {

constexpr std::size_t kRoom = 64U << 20U;  // bytes, for HDF5's tables and the answer

std::span<const std::byte> mapped(int descriptor) {
  struct stat status {};
  if (::fstat(descriptor, &status) != 0 || !S_ISREG(status.st_mode)) return {};
  const auto size = static_cast<std::size_t>(status.st_size);
  void* const start = ::mmap(nullptr, size, PROT_READ, MAP_PRIVATE, descriptor, 0);
  if (start == MAP_FAILED) return {};
  return {static_cast<const std::byte*>(start), size};
}

/// HDF5 makes its tables, and will look for no plugins, and print nothing.
void prepareHdf5() {
  H5dont_atexit();
  H5open();
  H5PLset_loading_state(0);
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
}

std::string answerTo(std::span<const std::byte> file) {
  try {
    ModelAnswer answer;
    (void)readModel(Hdf5Reader(file, answer), "");
    return answer.whole();
  } catch (const LoadError& error) {  // ": what", since the file has no name here
    return ModelAnswer::refusal(std::string(error.what()).substr(2));
  }
}

bool say(const std::string& answer) {
  for (std::span<const char> left = answer; !left.empty();) {
    const ssize_t put = ::write(STDOUT_FILENO, left.data(), left.size());
    if (put < 0) return false;
    left = left.subspan(static_cast<std::size_t>(put));
  }
  return true;
}

int run() {
  const std::span<const std::byte> file = mapped(STDIN_FILENO);
  if (file.empty()) return EX_OSERR;  // not the file's doing: ask_reader.cpp
  prepareHdf5();
  try {
    lockDown(STDOUT_FILENO, kRoom);
    return say(answerTo(file)) ? 0 : 1;
  } catch (const std::bad_alloc&) {
    return say(ModelAnswer::refusal("takes more to parse than " + std::to_string(kRoom >> 20U) +
                                    " MiB of memory, or than ulimit -v leaves"))
               ? 0
               : 1;
  } catch (const std::exception& error) {
    return say(ModelAnswer::refusal(error.what())) ? 0 : 1;
  }
}

}  // namespace
}  // namespace palpate

int main(int argc, char**) {
  if (argc == 1) ::_exit(palpate::run());
  std::fputs(
      "palpate-read-model: programs of palpate start it to parse a model file, it is not for the command "
      "line\n",
      stderr);
  return 2;
}
