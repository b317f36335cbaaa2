// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace palpate::rt {

/// What lockMemory() reached.
struct MemoryLock {
  int refused{0};  ///< errno of the refusal (ENOMEM or EPERM: raise RLIMIT_MEMLOCK or grant CAP_IPC_LOCK)
  bool present{false};  ///< all that was mapped at the call is locked
  bool future{false};   ///< and so is all that is mapped later: thread stacks, buffers of libraries
};

/// Locks the memory of the process, so that no tick waits for a page fault, and tells malloc to keep what it has, but for
/// pieces of 2 MiB and more, which go back when they are freed. Locks future mappings too, but only where no limit on
/// locked memory applies: under a limit, a library's next thread or buffer could not be mapped at all.
/// Real-time: no, before the loop.
[[nodiscard]] MemoryLock lockMemory() noexcept;

/// Threads made from here on, by libraries too, have stacks of at most 1 MiB: locked, one of the usual 8 MiB takes 8 MiB.
/// Real-time: no, before the first thread.
void shortenThreadStacks() noexcept;

/// Touches the next 256 kB of the calling thread's stack, so that the loop faults none of them in. Real-time: no, at the start of a thread.
void prefaultStack() noexcept;

}  // namespace palpate::rt
