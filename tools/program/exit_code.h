// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stdexcept>
#include <string>

namespace palpate::program {

/// What a program's end says, the same for all of them.                                        README.md, The programs
inline constexpr int kDone = 0;
inline constexpr int kFailed =
    1;                            ///< it began and could not end well: a damaged file, no server, a full disk
inline constexpr int kUsage = 2;  ///< the command line cannot be used; nothing was begun
inline constexpr int kNotHeld = 3;  ///< it ran to its end, and what was asserted or judged does not hold

/// The last line of every --help.
inline constexpr const char* kExitCodes =
    "Exit codes: 0 done, 1 failed, 2 the command line cannot be used, 3 an assertion or verdict does not "
    "hold.";

/// A command line that cannot be used: exit code 2. what() is one line that names the option.
class UsageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// What `check` refuses is the command line's fault: a UsageError with the same words.
/// @param[in] check  called at once, throws anything derived from std::exception
/// @param[in] option  put before the words, e.g. "--hand: "
template <class Check>
void orUsageError(Check&& check, const std::string& option = {}) {
  try {
    check();
  } catch (const std::exception& error) {
    throw UsageError(option + error.what());
  }
}

}  // namespace palpate::program
