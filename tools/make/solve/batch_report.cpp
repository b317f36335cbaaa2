// SPDX-License-Identifier: Apache-2.0
#include "tools/make/solve/batch_report.h"

#include <algorithm>
#include <array>
#include <vector>

#include "tools/program/printed.h"

namespace palpate::solve_program {

namespace {

using program::Json;
using program::printed;

struct StateWord {
  CaseState state;
  const char* word;  ///< of --json and in the table
  const char* text;  ///< in the last line
};
constexpr std::array kStates{
    StateWord{CaseState::kSolved, "solved", "solved"},
    StateWord{CaseState::kEstimated, "estimated", "to be solved"},
    StateWord{CaseState::kThere, "there", "there already"},
    StateWord{CaseState::kElsewhere, "elsewhere", "solved by another program now"},
    StateWord{CaseState::kFailed, "failed", "failed"},
};

const char* wordOf(CaseState state) {
  const auto* const found =
      std::find_if(kStates.begin(), kStates.end(), [&](const StateWord& one) { return one.state == state; });
  return found == kStates.end() ? "waiting" : found->word;
}

Json entryOf(const BatchCase& one) {
  Json entry{{"case", one.name()}, {"model", one.options.output.string()}, {"state", wordOf(one.state)}};
  if (!one.error.empty()) entry["error"] = one.error;
  if (!one.again.empty()) entry["again"] = one.again;
  if (!one.found.isNull()) entry[one.options.dry_run ? "estimate" : "solve"] = one.found;
  return entry;
}

/// Of all cases that have one.
Json sumOfEstimates(std::span<const BatchCase> cases) {
  double seconds = 0.0, memory = 0.0, scratch = 0.0, files = 0.0;
  for (const BatchCase& one : cases) {
    if (one.found.isNull()) continue;
    seconds += one.found.at("seconds").at("total").get<double>();
    memory = std::max(memory, one.found.at("memory_bytes").get<double>());
    scratch = std::max(scratch, one.found.at("scratch_bytes").get<double>());
    files += one.found.at("file_bytes").get<double>();
  }
  return {{"seconds", seconds}, {"memory_bytes", memory}, {"scratch_bytes", scratch}, {"file_bytes", files}};
}

using Row = std::vector<std::string>;

/// A number of the case's object; "-" where it has none.
std::string cell(const Json* value, double scale, const char* format) {
  return value == nullptr || !value->isNumber() ? "-" : printed(format, scale * value->get<double>());
}

Row rowOf(const BatchCase& one, bool dry_run) {
  Row row{one.name(), wordOf(one.state)};
  if (one.found.isNull()) return row;
  const Json& found = one.found;
  row.push_back(cell(found.at("seconds").find("total"), 1.0, "%.1f"));
  row.push_back(cell(found.find("file_bytes"), 1e-6, "%.1f"));
  if (dry_run) {
    row.push_back(cell(found.find("memory_bytes"), 1.0 / 1048576.0, "%.0f"));
    row.push_back(cell(found.find("scratch_bytes"), 1e-6, "%.0f"));
    return row;
  }
  row.push_back(cell(found.find("peak_memory_MiB"), 1.0, "%.0f"));
  row.push_back(cell(found.find("fit_p95"), 100.0, "%.2f"));
  const Json* const radius = found.find("domain_radius");
  row.push_back(cell(radius == nullptr ? nullptr : radius->find("median"), 1e3, "%.2f"));
  return row;
}

/// Names and words to the left, numbers to the right.
std::string aligned(const std::vector<Row>& rows) {
  std::vector<std::size_t> widths;
  for (const Row& row : rows) {
    widths.resize(std::max(widths.size(), row.size()));
    for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], row[i].size());
  }
  std::string text;
  for (const Row& row : rows) {
    std::string line;
    for (std::size_t i = 0; i < row.size(); ++i) {
      const std::string room(widths[i] - row[i].size(), ' ');
      line += (i == 0 ? "" : "  ") + (i < 2 ? row[i] + room : room + row[i]);
    }
    text += line.substr(0, line.find_last_not_of(' ') + 1) + '\n';
  }
  return text;
}

std::string sumLine(const Json& report) {
  std::string line;
  for (const StateWord& one : kStates) {
    const Json* const count = report.find(one.word);
    if (count == nullptr || *count == 0) continue;
    line += printed("%s%d %s", line.empty() ? "" : ", ", count->get<int>(), one.text);
  }
  if (const Json* const all = report.find("estimate"))
    return line + printed(
                      "; together about %s, at most %.0f MiB of memory and %.0f MB of scratch at once, %.0f "
                      "MB of files",
                      spanText(all->at("seconds").get<double>()).c_str(),
                      all->at("memory_bytes").get<double>() / 1048576.0,
                      1e-6 * all->at("scratch_bytes").get<double>(),
                      1e-6 * all->at("file_bytes").get<double>());
  return (line.empty() ? "no case" : line) + "; " + spanText(report.at("seconds").get<double>());
}

}  // namespace

std::string spanText(double seconds) {
  if (seconds < 120.0) return printed("%.0f s", seconds);
  if (seconds < 7200.0) return printed("%.0f min", seconds / 60.0);
  return printed("%.1f h", seconds / 3600.0);
}

Json batchReport(const Options& options, std::span<const BatchCase> cases, double seconds) {
  Json report{{"batch", options.batch.string()}, {"seconds", seconds}};
  if (options.worker) report["worker"] = *options.worker;
  for (const StateWord& one : kStates) {
    if (one.state == CaseState::kEstimated && !options.dry_run) continue;
    report[one.word] = std::count_if(cases.begin(), cases.end(),
                                     [&](const BatchCase& each) { return each.state == one.state; });
  }
  if (options.dry_run) {
    report["dry_run"] = true;
    report["estimate"] = sumOfEstimates(cases);
  }
  report["cases"] = Json::array();
  for (const BatchCase& one : cases) report["cases"].push_back(entryOf(one));
  return report;
}

std::string batchTable(std::span<const BatchCase> cases, const Json& report) {
  const bool dry_run = report.contains("dry_run");
  std::vector<Row> rows{
      dry_run ? Row{"case", "state", "s", "MB", "MiB of memory", "MB of scratch"}
              : Row{"case", "state", "s", "MB", "MiB of memory", "field error / %", "d_max / mm"}};
  for (const BatchCase& one : cases) rows.push_back(rowOf(one, dry_run));
  return aligned(rows) + sumLine(report) + '\n';
}

}  // namespace palpate::solve_program
