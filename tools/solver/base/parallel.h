// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <string>

namespace palpate::solver {

/// Runs work(worker, chunk) for chunk = 0 .. chunks - 1, each once, on `workers` threads; BLAS uses one
/// thread meanwhile. The first exception of a worker stops the others and is thrown again here.
void parallelFor(int workers, std::size_t chunks,
                 const std::function<void(int worker, std::size_t chunk)>& work);

/// OpenBLAS's version and the kind of processor that it computes for: others round otherwise.
[[nodiscard]] std::string blasVersion();

/// Hardware threads of the machine, at least 1.
[[nodiscard]] int machineThreads();

}  // namespace palpate::solver
