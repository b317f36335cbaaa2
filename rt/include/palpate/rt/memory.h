// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace palpate::rt {

/// What lockMemory() reached.
struct MemoryLock {
  int refused{0};  ///< errno of the refusal (ENOMEM or EPERM: raise RLIMIT_MEMLOCK or grant CAP_IPC_LOCK)
  bool present{false};  ///< all that was mapped at the call is locked
  bool future{false};   ///< and so is all that is mapped later: thread stacks, buffers of libraries
};

/// Locks the memory of the process, so that no page fault waits inside a tick, and tells malloc to keep what
/// it has. Future mappings are locked as well only where no limit on locked memory applies: under a limit the
/// next thread or buffer of a library would fail to map instead of merely not being locked.
/// Real-time: no, before the loop.
[[nodiscard]] MemoryLock lockMemory() noexcept;

/// Touches the next kilobytes of the calling thread's stack, so that the loop does not fault them in one by
/// one. Real-time: no, at the start of a thread.
void prefaultStack() noexcept;

}  // namespace palpate::rt
