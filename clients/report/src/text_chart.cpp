// SPDX-License-Identifier: Apache-2.0
#include "palpate/report/text_chart.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "palpate/client/time_summary.h"
#include "tools/program/printed.h"

namespace palpate::report {
namespace {

using program::printed;

constexpr std::array<const char*, 9> kBlocks{" ", "▁", "▂", "▃", "▄", "▅", "▆", "▇", "█"};

std::vector<double> columnsOf(const std::vector<double>& x, const std::vector<double>& y, std::size_t width) {
  std::vector<double> columns(width, 0.0);
  const double span = x.back() - x.front();
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double share = span > 0.0 ? (x[i] - x.front()) / span : 0.0;
    double& column =
        columns[std::min(static_cast<std::size_t>(share * static_cast<double>(width)), width - 1)];
    column = std::max(column, y[i]);
  }
  return columns;
}

}  // namespace

std::string textChart(const std::vector<double>& x, const std::vector<double>& y, const std::string& x_label,
                      const std::string& y_label, std::size_t width, std::size_t height) {
  if (x.empty() || x.size() != y.size() || width == 0 || height == 0) return "(no samples)\n";
  const std::vector<double> columns = columnsOf(x, y, width);
  const double top = *std::max_element(columns.begin(), columns.end());
  std::string text = "  " + y_label + "\n";
  for (std::size_t row = height; row-- > 0;) {
    text += row + 1 == height ? printed("%9.3g ┤", top) : row == 0 ? "        0 ┤" : "          │";
    for (const double value : columns) {
      const double filled =
          top > 0.0 ? value / top * static_cast<double>(height) - static_cast<double>(row) : 0.0;
      text += kBlocks[static_cast<std::size_t>(std::lround(std::clamp(filled, 0.0, 1.0) * 8.0))];
    }
    text += '\n';
  }
  return text + "           " + printed("%.3g", x.front()) + " to " + printed("%.3g ", x.back()) + x_label +
         '\n';
}

std::string textHistogram(const rt::CycleStats& histogram, int per_decade) {
  const auto bars = client::barsOf(histogram, per_decade);
  std::uint64_t most = 0;
  for (const auto& bar : bars) most = std::max(most, bar.count);
  std::string text;
  for (const auto& bar : bars) {
    const double share =
        bar.count == 0 ? 0.0
                       : std::log1p(static_cast<double>(bar.count)) / std::log1p(static_cast<double>(most));
    text += printed("%10.1f", bar.from_ns * 1e-3) + printed(" .. %8.1f us ", bar.to_ns * 1e-3) +
            printed("%9.0f ", static_cast<double>(bar.count));
    for (long i = 0; i < std::lround(share * 40.0); ++i) text += "█";
    text += '\n';
  }
  return text;
}

}  // namespace palpate::report
