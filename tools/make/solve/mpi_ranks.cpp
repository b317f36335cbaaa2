// SPDX-License-Identifier: Apache-2.0
#define OMPI_SKIP_MPICXX 1
#include <mpi.h>

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <initializer_list>
#include <stdexcept>
#include <string>
#include <string_view>

#include "tools/make/solve/start_ranks.h"
#include "tools/program/exit_code.h"

namespace palpate::solve_program {

namespace {

/// MPI counts in int.
constexpr std::size_t kMostBytes = std::size_t{1} << 30U;

class MpiRanks : public solver::Ranks {
 public:
  MpiRanks() {
    int given = 0;
    MPI_Init_thread(nullptr, nullptr, MPI_THREAD_FUNNELED, &given);
    if (given < MPI_THREAD_FUNNELED)
      throw std::runtime_error("this MPI allows no threads beside the one that calls it");
    MPI_Comm_rank(MPI_COMM_WORLD, &rank_);
    MPI_Comm_size(MPI_COMM_WORLD, &size_);
    MPI_Comm machine = MPI_COMM_NULL;
    MPI_Comm_split_type(MPI_COMM_WORLD, MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &machine);
    MPI_Comm_size(machine, &on_machine_);
    MPI_Comm_free(&machine);
  }
  [[nodiscard]] int rank() const noexcept override { return rank_; }
  [[nodiscard]] int size() const noexcept override { return size_; }
  [[nodiscard]] int onMachine() const noexcept override { return on_machine_; }
  void broadcast(std::span<std::byte> data, int from) const override {
    for (; !data.empty(); data = data.subspan(std::min(kMostBytes, data.size())))
      MPI_Bcast(data.data(), countOf(data), MPI_BYTE, from, MPI_COMM_WORLD);
  }
  void move(std::span<std::byte> data, int from, int to) const override {
    for (; !data.empty(); data = data.subspan(std::min(kMostBytes, data.size()))) {
      if (rank_ == from) MPI_Send(data.data(), countOf(data), MPI_BYTE, to, 0, MPI_COMM_WORLD);
      if (rank_ == to)
        MPI_Recv(data.data(), countOf(data), MPI_BYTE, from, 0, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
    }
  }

 private:
  [[nodiscard]] static int countOf(std::span<std::byte> data) {
    return static_cast<int>(std::min(kMostBytes, data.size()));
  }

  int rank_{0}, size_{1}, on_machine_{1};
};

/// What Open MPI's mpirun, and launchers that speak PMIx or PMI, tell their processes. Without a launcher MPI would start one.
bool isLaunched() {
  for (const char* name : {"OMPI_COMM_WORLD_SIZE", "PMIX_RANK", "PMI_SIZE"})
    if (std::getenv(name) != nullptr) return true;
  return false;
}

/// A number of processes from the environment; 1 where there is none.
/// @throw program::UsageError  naming the variable and what it says
int processesBy(const char* name) {
  const char* const said = std::getenv(name);
  if (said == nullptr) return 1;
  const std::string_view text(said);
  int number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size() || number < 1)
    throw program::UsageError(std::string(name) + " is '" + said + "', expected a number of processes");
  return number;
}

/// A launcher of another MPI starts processes of which each believes that it is alone.
/// @throw program::UsageError
void requireKnown(int size, int started) {
  if (size > 1 || started <= 1) return;
  MPI_Finalize();
  throw program::UsageError("the launcher says that there are " + std::to_string(started) +
                            " processes, MPI knows of one: mpirun has to be Open MPI's, as this program is");
}

}  // namespace

const solver::Ranks& startRanks() {
  if (!isLaunched()) return solver::Ranks::one();
  const int started = std::max(processesBy("OMPI_COMM_WORLD_SIZE"), processesBy("PMI_SIZE"));
  static const MpiRanks ranks;
  requireKnown(ranks.size(), started);
  return ranks;
}

void endRanks(int code) {
  int begun = 0, ended = 0;
  MPI_Initialized(&begun);
  MPI_Finalized(&ended);
  if (begun == 0 || ended != 0) return;
  if (code != 0) MPI_Abort(MPI_COMM_WORLD, code);
  MPI_Finalize();
}

}  // namespace palpate::solve_program
