// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>

namespace palpate {

/// Threads that a load may use: those that run at once for this process, at most 4; 1 where there are none
/// (core/wasm/serial.cpp).
[[nodiscard]] int loadThreads() noexcept;

/// Runs work(worker, chunk) for chunk = 0 .. chunks - 1, each once, on up to `workers` threads, the caller's among them; fewer
/// where no more can be started. The first exception of a worker stops the others and is thrown again here. Not real-time.
void parallelFor(int workers, std::size_t chunks,
                 const std::function<void(int worker, std::size_t chunk)>& work);

}  // namespace palpate
