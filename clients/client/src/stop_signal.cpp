// SPDX-License-Identifier: Apache-2.0
#include "palpate/client/stop_signal.h"

#include <atomic>
#include <csignal>

namespace palpate::client {
namespace {

std::atomic<bool> g_stop_requested{false};
static_assert(std::atomic<bool>::is_always_lock_free, "a signal handler may only store to a lock-free flag");

extern "C" void onStopSignal(int) {
  g_stop_requested.store(true, std::memory_order_relaxed);
}

}  // namespace

void catchStopSignals() {
  struct sigaction action = {};
  action.sa_handler = &onStopSignal;
  action.sa_flags = static_cast<int>(SA_RESETHAND);
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
}

bool stopRequested() noexcept {
  return g_stop_requested.load(std::memory_order_relaxed);
}

}  // namespace palpate::client
