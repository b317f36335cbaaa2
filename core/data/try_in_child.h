// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <functional>
#include <string>

namespace palpate {

/// How long a child is waited for, whatever it does; after that it is killed.
struct Patience {
  std::chrono::milliseconds most{30'000};      ///< three times its processor time: the machine may be busy
  const std::atomic<bool>* given_up{nullptr};  ///< set: nobody wants to know it; looked at ten times a second
};

/// Does something in a child process that may take 10 s of processor time and, beside what this one has, 64 MiB and eight
/// times the file's size of addresses: numbers of 8 bits may be wanted in 64. What crashes or runs away there is not done here.
/// @param[in] name  of the file in messages  @param[in] bytes  size of the file
/// @param[in] work  gives the same result when it is done again here
/// Not where threads that must not wait run beside it: fork() has the kernel copy the page tables, and each page is copied when it
/// is written next. There: tryInProgram().
/// @throw LoadError  as `work` threw it in the child, or the child crashed, ran out of its limits, of time or cannot be started
void tryInChild(const std::string& name, std::size_t bytes, const std::function<void()>& work,
                const Patience& patience = {});

/// The same in this process's own program, started again (/proc/self/exe): nothing of this process is copied, and no other
/// thread of it waits. That program calls answerTrial() when it is started with `argument`, the name and the size.
/// @param[in] argument    the program's first argument, e.g. "--try-model"
/// @param[in] descriptor  of the file's copy; the program finds it as kTrialImage
/// @throw LoadError  as above
void tryInProgram(const std::string& name, std::size_t bytes, const std::string& argument, int descriptor,
                  const Patience& patience = {});

inline constexpr int kTrialImage = 3;

/// The other end of tryInProgram(): sets the limits, lets signals through, does the work, and says how it went. Does not return.
[[noreturn]] void answerTrial(const std::string& name, std::size_t bytes, const std::function<void()>& work);

}  // namespace palpate
