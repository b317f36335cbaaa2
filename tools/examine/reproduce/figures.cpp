// SPDX-License-Identifier: Apache-2.0
#include "tools/examine/reproduce/figures.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <limits>
#include <sstream>

namespace palpate::reproduce {

namespace {

/// Text in gnuplot's double quotes; keeps subscripts, removes quotes and backslashes.
std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text)
    if (c != '"' && c != '\\' && c != '\n') out += c;
  return out + "\"";
}

std::string terminal(const std::filesystem::path& image, int width, int height) {
  const bool svg = image.extension() == ".svg";
  std::ostringstream out;
  out << "set terminal "
      << (svg ? "svg background '#ffffff' font 'sans-serif,14'" : "pngcairo font 'sans-serif,12'") << " size "
      << width << "," << height << "\nset output " << quoted(image.string()) << '\n';
  return out.str();
}

/// Feeds gnuplot through a pipe. @return whether it drew
bool run(const std::filesystem::path& image, const std::string& script) {
  std::FILE* const pipe = popen("gnuplot -", "w");
  bool good = pipe != nullptr;
  if (good) good = std::fwrite(script.data(), 1, script.size(), pipe) == script.size();
  if (pipe != nullptr) good = pclose(pipe) == 0 && good;
  std::error_code ignored;
  good = good && std::filesystem::file_size(image, ignored) > 0 && !ignored;
  if (good) return true;
  std::filesystem::remove(image, ignored);
  std::cerr << "palpate-reproduce: " << image.string()
            << " is not drawn: gnuplot failed or is not installed (Debian: gnuplot-nox)\n";
  return false;
}

/// A logarithmic x axis that ends just beyond the points and not at the next power of ten.
std::string logRange(const Chart& chart) {
  constexpr double kBeyond = 1.4;
  double least = std::numeric_limits<double>::infinity(), most = 0.0;
  for (const Curve& curve : chart.curves)
    for (const auto& [x, y] : curve.points) {
      if (x > 0.0) least = std::min(least, x);
      most = std::max(most, x);
    }
  std::ostringstream out;
  if (most > 0.0) out << "set xrange [" << least / kBeyond << ':' << most * kBeyond << "]\n";
  return out.str();
}

void addPoints(std::ostringstream& out, const Chart& chart, const Curve& curve) {
  for (const auto& [x, y] : curve.points) {
    const bool shown =
        std::isfinite(x) && std::isfinite(y) && !(chart.log_x && !(x > 0.0)) && !(chart.log_y && !(y > 0.0));
    if (shown) out << x << ' ' << y << '\n';
  }
}

/// A triangle as a grid of two lines of two points, the last point twice, so that pm3d colours it by node.
void addTriangle(std::ostringstream& out, const SurfacePanel& panel,
                 const std::array<std::int32_t, 3>& triangle) {
  const auto point = [&](std::size_t corner) {
    const auto node = static_cast<std::size_t>(triangle[corner]);
    const Eigen::Vector3d& x = panel.positions[node];
    out << x[0] << ' ' << x[1] << ' ' << x[2] << ' ' << (panel.values.empty() ? 0.0 : panel.values[node])
        << '\n';
  };
  point(0);
  point(1);
  out << '\n';
  point(2);
  point(2);
  out << "\n\n";
}

std::string colourRange(const SurfacePanel& panel, bool diverging) {
  if (panel.values.empty()) return "set palette defined (0 '#d9e2ec', 1 '#d9e2ec')\nset cbrange [-1:1]\n";
  const auto [least, most] = std::minmax_element(panel.values.begin(), panel.values.end());
  double low = diverging ? -std::max(std::abs(*least), std::abs(*most)) : std::min(0.0, *least);
  double high = diverging ? -low : *most;
  if (!(high > low)) high = low + 1.0;
  std::ostringstream out;
  out << "set cbrange [" << low << ':' << high << "]\n";
  return out.str();
}

int columnsOf(const SurfaceFigure& figure) {
  return std::max(1, std::min(figure.columns, static_cast<int>(figure.panels.size())));
}

/// The colour scale below its panel, in shares of the whole picture.
std::string colourScale(const SurfaceFigure& figure, std::size_t i) {
  if (figure.colour_label.empty()) return "";
  const auto columns = static_cast<std::size_t>(columnsOf(figure)),
             rows = (figure.panels.size() - 1) / columns + 1;
  std::ostringstream out;
  out << "set colorbox horizontal user origin "
      << (static_cast<double>(i % columns) + 0.3) / static_cast<double>(columns) << ','
      << (static_cast<double>(rows - 1 - i / columns) + 0.16) / static_cast<double>(rows) << " size "
      << 0.4 / static_cast<double>(columns) << ",0.025\n";
  return out.str();
}

void addPanel(std::ostringstream& out, const SurfaceFigure& figure, std::size_t i) {
  const SurfacePanel& panel = figure.panels[i];
  out << "$panel" << i << " << END_OF_DATA\n";
  for (const auto& triangle : panel.triangles) addTriangle(out, panel, triangle);
  out << "END_OF_DATA\nset title " << quoted(panel.title) << '\n'
      << colourRange(panel, figure.diverging) << colourScale(figure, i) << "set pm3d border "
      << (panel.values.empty() ? "lw 0.3 lc rgb '#404040'\n" : "lw 0.1 lc rgb '#c0808080'\n")
      << "splot $panel" << i << " using 1:2:3:4 with pm3d\n";
}

}  // namespace

bool drawChart(const std::filesystem::path& image, const Chart& chart) {
  // Okabe and Ito's colours, which colour-blind readers can tell apart.
  static constexpr const char* kColours[] = {"#0072b2", "#d55e00", "#009e73", "#cc79a7",
                                             "#e69f00", "#56b4e9", "#000000"};
  std::ostringstream out;
  out.precision(10);
  out << terminal(image, 900, 460)
      << "set grid lc rgb '#dddddd'\nset key outside right top Left reverse samplen 2\nset title "
      << quoted(chart.title) << "\nset xlabel " << quoted(chart.x_label) << "\nset ylabel "
      << quoted(chart.y_label) << '\n';
  if (chart.log_x) out << "set logscale x\nset format x '10^{%L}'\n" << logRange(chart);
  if (chart.log_y) out << "set logscale y\nset format y '10^{%L}'\n";
  std::ostringstream plot;
  for (std::size_t i = 0; i < chart.curves.size(); ++i) {
    const Curve& curve = chart.curves[i];
    out << "$curve" << i << " << END_OF_DATA\n";
    addPoints(out, chart, curve);
    out << "END_OF_DATA\n";
    plot << (i == 0 ? "plot " : ", ") << "$curve" << i << " using 1:2 with "
         << (!curve.lines  ? "points pt 7 ps 0.5"
             : curve.marks ? "linespoints pt 7 ps 0.6"
                           : "lines")
         << " lw 2 dt " << (curve.dashed ? 2 : 1) << " lc rgb '" << kColours[i % std::size(kColours)]
         << "' title " << quoted(curve.name);
  }
  return run(image, out.str() + plot.str() + '\n');
}

bool drawSurfaces(const std::filesystem::path& image, const SurfaceFigure& figure) {
  const int columns = columnsOf(figure);
  const int rows = (static_cast<int>(figure.panels.size()) + columns - 1) / columns;
  const int width = figure.panels.size() > 2 ? 440 : 640;  // of a panel, pixels
  std::ostringstream out;
  out << terminal(image, width * columns, width * 3 / 4 * rows + 40) << "set multiplot layout " << rows << ','
      << columns << " title " << quoted(figure.title) << "\nset view equal xyz\nset view " << figure.elevation
      << ',' << figure.azimuth << ',' << figure.zoom << "\nunset border\nunset tics\nunset key\n"
      << "set pm3d depthorder corners2color mean\nset pm3d lighting primary 0.35 specular 0.1\n"
      << (figure.diverging
              ? "set palette defined (-1 '#2166ac', -0.5 '#92c5de', 0 '#f7f7f7', 0.5 '#f4a582', 1 "
                "'#b2182b')\n"
              : "set palette defined (0 '#ffffd9', 0.3 '#7fcdbb', 0.7 '#1d91c0', 1 '#0c2c84')\n");
  if (figure.colour_label.empty())
    out << "unset colorbox\n";
  else
    out << "set cblabel " << quoted(figure.colour_label) << "\nset cbtics\n";
  for (std::size_t i = 0; i < figure.panels.size(); ++i) addPanel(out, figure, i);
  out << "unset multiplot\n";
  return run(image, out.str());
}

}  // namespace palpate::reproduce
