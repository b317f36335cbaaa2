// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

namespace palpate {

/// Leaves this process nothing but memory that cannot be run, writing to one descriptor, and its end. No file can be opened
/// (EACCES), and any other system call kills it (SIGSYS): reading, sockets, processes, signals. For good, so call it before
/// the first byte of what may be hostile.
/// @param[in] output  the descriptor  @param[in] room  memory that it may take beside what it has, bytes
/// 10 s of processor time, no core dump. For a process of one thread.
/// @throw std::runtime_error  the kernel cannot do it
void lockDown(int output, std::size_t room);

}  // namespace palpate
