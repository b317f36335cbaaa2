// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <string>

namespace palpate::solver {

/// OpenBLAS computes with one thread while this lives: with several, last bits depend on how many there are.
class SerialBlas {
 public:
  SerialBlas();
  ~SerialBlas();
  SerialBlas(const SerialBlas&) = delete;
  SerialBlas& operator=(const SerialBlas&) = delete;

 private:
  int threads_;
};

/// Runs work(worker, chunk) for chunk = 0 .. chunks - 1, each once, on `workers` threads; BLAS uses one
/// thread meanwhile. The first exception of a worker stops the others and is thrown again here.
void parallelFor(int workers, std::size_t chunks,
                 const std::function<void(int worker, std::size_t chunk)>& work);

/// OpenBLAS's version and the kind of processor that it computes for: others round otherwise.
[[nodiscard]] std::string blasVersion();

/// Hardware threads of the machine, at least 1.
[[nodiscard]] int machineThreads();

}  // namespace palpate::solver
