// SPDX-License-Identifier: Apache-2.0
// tools/soak --simulated runs this: hours of server time by a tick that does not sleep.
#include <cmath>
#include <iostream>

#include "palpate/rt/thread.h"
#include "simulated_hours.h"
#include "tools/program/command_line.h"
#include "tools/program/json.h"
#include "tools/program/printed.h"
#include "tools/program/run.h"

namespace palpate::proof {
namespace {

// What memory may grow by from the first row's end, MiB.
constexpr double kGrowth = 1.0;

std::string lineOf(std::size_t number, const SimulatedRow& row) {
  return program::printed(
      "%5zu %9llu %7.0f %9llu %7.3f %6llu %6llu %9llu %9.2g %6llu %6llu %5llu %6llu %8.2f\n", number,
      static_cast<unsigned long long>(row.ticks), row.seconds,
      static_cast<unsigned long long>(row.in_contact), row.largest_force,
      static_cast<unsigned long long>(row.not_finite), static_cast<unsigned long long>(row.beyond_limit),
      static_cast<unsigned long long>(row.differing), row.largest_difference,
      static_cast<unsigned long long>(row.out_of_step), static_cast<unsigned long long>(row.faults),
      static_cast<unsigned long long>(row.lost), static_cast<unsigned long long>(row.allocations),
      row.resident_MiB);
}

program::Json jsonOf(const SimulatedRow& row) {
  return {{"ticks", row.ticks},
          {"seconds", row.seconds},
          {"in_contact", row.in_contact},
          {"cut_short", row.cut_short},
          {"largest_force_N", row.largest_force},
          {"not_finite", row.not_finite},
          {"beyond_limit", row.beyond_limit},
          {"differing", row.differing},
          {"largest_difference_N", row.largest_difference},
          {"out_of_step", row.out_of_step},
          {"faults", row.faults},
          {"lost", row.lost},
          {"allocations", row.allocations},
          {"resident_MiB", row.resident_MiB},
          {"holds", row.holds()}};
}

int body(int argc, char** argv) {
  program::CommandLine line("simulated_hours",
                            "Hours of server time by a tick that does not sleep: tools/soak --simulated.");
  std::filesystem::path file;
  double hours = 0.0;
  bool json = false;
  program::Options options = line.options();
  options.add("MODEL", &file, "model file").required();
  options.add("HOURS", &hours, "of simulated time").required().range(0.001, 1000.0, "h");
  options.flag("--json", &json, "print one JSON object on standard output");
  if (!line.read(argc, argv)) return program::kDone;

  const auto model = std::make_shared<const MetaModel>(MetaModel::load(file));
  const double an_hour = 3600.0e3 / static_cast<double>(kSessionTicks);
  SimulatedOptions asked;
  asked.sessions = std::max<std::uint64_t>(3, static_cast<std::uint64_t>(std::llround(hours * an_hour)));
  asked.sessions_a_row =
      hours < 2.0 ? std::max<std::uint64_t>(2, asked.sessions / 4) : static_cast<std::uint64_t>(an_hour);
  std::ostream& out = json ? std::cerr : std::cout;
  out << "  row     ticks  time/s   contact   max/N not    beyond differing difference out of\n"
         "                                          finite limit   answers         N   step  fault  lost  "
         "alloc      MiB\n";
  std::size_t number = 0;
  const auto rows = simulateHours(
      model, asked, [&](const SimulatedRow& row) { out << lineOf(++number, row) << std::flush; });

  bool holds = rows.back().resident_MiB - rows.front().resident_MiB <= kGrowth;
  program::Json list = program::Json::array();
  for (const SimulatedRow& row : rows) {
    holds = holds && row.holds();
    list.push_back(jsonOf(row));
  }
  out << (holds ? "holds" : "BROKEN")
      << ": from the second session of 8 s on all have the same forces to the bit, all is finite and in "
         "step, "
      << "no tick allocates, memory grew by " << rows.back().resident_MiB - rows.front().resident_MiB
      << " MiB, " << kGrowth << " allowed\n";
  if (json) program::printJson({{"model", file.string()}, {"holds", holds}, {"rows", list}});
  return holds ? program::kDone : program::kNotHeld;
}

}  // namespace
}  // namespace palpate::proof

int main(int argc, char** argv) {
  return palpate::program::runProgram("simulated_hours", &palpate::proof::body, argc, argv);
}
