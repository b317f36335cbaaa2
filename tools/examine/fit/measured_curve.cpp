// SPDX-License-Identifier: Apache-2.0
#include "tools/examine/fit/measured_curve.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>
#include <fstream>
#include <iterator>
#include <optional>
#include <span>
#include <string_view>

#include "tools/examine/fit/fit_error.h"

namespace palpate::fit {

namespace {

struct Unit {
  std::string_view name;
  double size;  // m or N
};
constexpr std::array<Unit, 4> kLengths{{{"m", 1.0}, {"mm", 1e-3}, {"um", 1e-6}, {"µm", 1e-6}}};
constexpr std::array<Unit, 3> kForces{{{"N", 1.0}, {"mN", 1e-3}, {"kN", 1e3}}};

/// One column that is read.
struct Column {
  std::size_t place;  // 0-based in a line
  double unit;
  std::string title;  // as the file has it
};

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view kOutside = " \t\r\"";
  const std::size_t first = text.find_first_not_of(kOutside);
  return first == std::string_view::npos ? std::string_view()
                                         : text.substr(first, text.find_last_not_of(kOutside) - first + 1);
}

/// Without regard to case. @param name  in lower case
bool startsWith(std::string_view title, std::string_view name) {
  const auto lower = [](char letter) { return letter >= 'A' && letter <= 'Z' ? letter - 'A' + 'a' : letter; };
  return title.size() >= name.size() &&
         std::equal(name.begin(), name.end(), title.begin(),
                    [&](char wanted, char letter) { return wanted == lower(letter); });
}

std::vector<std::string_view> cellsOf(std::string_view line, char separator) {
  std::vector<std::string_view> cells;
  for (std::size_t start = 0; start <= line.size();) {
    const std::size_t end = std::min(line.find(separator, start), line.size());
    cells.push_back(trimmed(line.substr(start, end - start)));
    start = end + 1;
  }
  return cells;
}

/// Reads one text; knows where it is.
class CurveReader {
 public:
  CurveReader(const std::string& name, std::string_view text) : name_(name), rest_(text) {
    constexpr std::string_view kMark = "\xEF\xBB\xBF";  // of UTF-8, which some programs write
    if (rest_.starts_with(kMark)) rest_.remove_prefix(kMark.size());
  }

  MeasuredCurve read() {
    readTitles();
    const std::optional<Column> error = column("force_error", kForces);
    const Column depth = required("depth", kLengths), force = required("force", kForces);
    MeasuredCurve curve;
    curve.name = name_;
    curve.has_errors = error.has_value();
    while (nextLine()) {
      const std::vector<std::string_view> cells = cellsOf(line_, separator_);
      MeasuredPoint point{number(cells, depth), number(cells, force)};
      if (error) point.error = positive(cells, *error);
      curve.points.push_back(point);
    }
    return curve;
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw FitError(name_ + ", line " + std::to_string(number_) + ": " + what);
  }

  /// The next line that says something. @return false at the end
  bool nextLine() {
    while (!rest_.empty()) {
      const std::size_t end = std::min(rest_.find('\n'), rest_.size());
      line_ = rest_.substr(0, end);
      rest_.remove_prefix(std::min(end + 1, rest_.size()));
      ++number_;
      if (!trimmed(line_).empty() && trimmed(line_).front() != '#') return true;
    }
    return false;
  }

  void readTitles() {
    if (!nextLine()) throw FitError(name_ + " has no line that names its columns, such as depth_mm,force_N");
    for (const char separator : {'\t', ';', ','})
      if (line_.find(separator) != std::string_view::npos) {
        separator_ = separator;
        break;
      }
    titles_ = cellsOf(line_, separator_);
  }

  /// The unit in a title such as "depth_mm", "Depth [mm]"; nothing where the title is of something else, as "depth_rate_mm".
  static std::optional<std::string_view> unitIn(std::string_view title, std::string_view name) {
    constexpr std::string_view kBetween = " _[(/";
    if (!startsWith(title, name)) return {};
    const std::string_view rest = title.substr(name.size());
    const std::size_t first = rest.find_first_not_of(kBetween);
    if (first == 0) return {};  // a longer word
    if (first == std::string_view::npos) return std::string_view();
    const std::string_view unit = rest.substr(first, rest.find_last_not_of(" ])") + 1 - first);
    if (unit.find_first_of(kBetween) != std::string_view::npos) return {};  // more words than a unit
    return unit;
  }

  std::optional<Column> column(std::string_view name, std::span<const Unit> units) const {
    std::optional<Column> found;
    std::string_view unknown;  // a title whose unit is not among these
    for (std::size_t i = 0; i < titles_.size(); ++i) {
      const auto unit = unitIn(titles_[i], name);
      if (!unit) continue;
      const auto known =
          std::find_if(units.begin(), units.end(), [&](const Unit& one) { return one.name == *unit; });
      if (known == units.end()) {
        unknown = titles_[i];
        continue;
      }
      if (found)
        fail("two columns are " + std::string(name) + ": '" + found->title + "' and '" +
             std::string(titles_[i]) + "'");
      found = Column{i, known->size, std::string(titles_[i])};
    }
    if (!found && !unknown.empty()) failOfUnit(unknown, *unitIn(unknown, name), units);
    return found;
  }

  Column required(std::string_view name, std::span<const Unit> units) const {
    if (const auto found = column(name, units)) return *found;
    fail("no column is named " + std::string(name) + " with its unit, such as " +
         (name == "depth" ? "depth_mm" : "force_N") + ": found '" + std::string(trimmed(line_)) + "'");
  }

  [[noreturn]] void failOfUnit(std::string_view title, std::string_view unit,
                               std::span<const Unit> units) const {
    std::string known;
    for (const Unit& one : units) (known += known.empty() ? "" : ", ") += one.name;
    fail("column '" + std::string(title) + "' has " +
         (unit.empty() ? "no unit" : "the unit '" + std::string(unit) + "'") + ", expected one of " + known);
  }

  double number(const std::vector<std::string_view>& cells, const Column& column) const {
    if (column.place >= cells.size())
      fail("has " + std::to_string(cells.size()) + " columns, expected '" + column.title + "' in column " +
           std::to_string(column.place + 1));
    std::string_view cell = cells[column.place];
    if (cell.starts_with('+')) cell.remove_prefix(1);
    double value = 0.0;
    const auto [end, failure] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
    if (failure != std::errc() || end != cell.data() + cell.size() || !std::isfinite(value))
      fail("column '" + column.title + "' is '" + std::string(cell) +
           "', expected a finite number with a decimal point");
    return value * column.unit;
  }

  double positive(const std::vector<std::string_view>& cells, const Column& column) const {
    const double value = number(cells, column);
    if (!(value > 0.0))
      fail("column '" + column.title + "' is '" + std::string(cells[column.place]) +
           "', expected a standard error above 0");
    return value;
  }

  const std::string& name_;
  std::string_view rest_, line_;
  std::vector<std::string_view> titles_;
  char separator_{','};
  int number_{0};  // of line_, from 1
};

}  // namespace

MeasuredCurve parseCurve(const std::string& name, const std::string& text) {
  return CurveReader(name, text).read();
}

MeasuredCurve readCurve(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file || std::filesystem::is_directory(path))
    throw FitError("cannot read " + path.string() + ": " + std::strerror(file ? EISDIR : errno));
  return parseCurve(path.string(), {std::istreambuf_iterator<char>(file), {}});
}

}  // namespace palpate::fit
