// SPDX-License-Identifier: Apache-2.0
#include "tools/examine/query/touch_table.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <fstream>
#include <iterator>

#include "tools/examine/query/query_error.h"

namespace palpate::query {

namespace {

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view kOutside = " \t\r";
  const std::size_t first = text.find_first_not_of(kOutside);
  return first == std::string_view::npos ? std::string_view()
                                         : text.substr(first, text.find_last_not_of(kOutside) - first + 1);
}

std::vector<std::string_view> cellsOf(std::string_view line) {
  std::vector<std::string_view> cells;
  for (std::size_t start = 0; start <= line.size();) {
    const std::size_t end = std::min(line.find(',', start), line.size());
    cells.push_back(trimmed(line.substr(start, end - start)));
    start = end + 1;
  }
  return cells;
}

std::string knownColumns() {
  std::string text;
  for (const std::string_view column : kTouchColumns) text += (text.empty() ? "" : ",") + std::string(column);
  return text;
}

/// Reads one text; knows where it is.
class TouchReader {
 public:
  TouchReader(const std::string& name, std::string_view text, const program::LengthUnit& unit)
      : name_(name), rest_(text), unit_(unit) {
    constexpr std::string_view kMark = "\xEF\xBB\xBF";  // of UTF-8, which some programs write
    if (rest_.starts_with(kMark)) rest_.remove_prefix(kMark.size());
  }

  std::vector<TouchRow> read() {
    if (!nextLine()) throw QueryError(name_ + " is empty, expected a line of columns: " + knownColumns());
    readTitles();
    std::vector<TouchRow> rows;
    while (nextLine()) rows.push_back(row());
    if (rows.empty()) throw QueryError(name_ + " has no line below that of its columns");
    return rows;
  }

 private:
  [[nodiscard]] std::string place() const { return name_ + ", line " + std::to_string(number_); }

  /// The next line that says something. @return false at the end
  bool nextLine() {
    while (!rest_.empty()) {
      const std::size_t end = std::min(rest_.find('\n'), rest_.size());
      line_ = trimmed(rest_.substr(0, end));
      rest_.remove_prefix(std::min(end + 1, rest_.size()));
      ++number_;
      if (!line_.empty() && line_.front() != '#') return true;
    }
    return false;
  }

  void readTitles() {
    const std::vector<std::string_view> titles = cellsOf(line_);
    columns_ = titles.size();
    for (const std::string_view title : titles)
      if (std::find(kTouchColumns.begin(), kTouchColumns.end(), title) == kTouchColumns.end())
        throw QueryError(place() + ": column '" + std::string(title) + "' is not known, expected " +
                         knownColumns());
    for (std::size_t i = 0; i < kTouchColumns.size(); ++i) {
      const auto found = std::find(titles.begin(), titles.end(), kTouchColumns[i]);
      if (found == titles.end())
        throw QueryError(place() + ": no column is " + std::string(kTouchColumns[i]) + ", expected " +
                         knownColumns());
      if (std::find(found + 1, titles.end(), kTouchColumns[i]) != titles.end())
        throw QueryError(place() + ": two columns are " + std::string(kTouchColumns[i]));
      cell_of_[i] = static_cast<std::size_t>(found - titles.begin());
    }
  }

  [[nodiscard]] TouchRow row() const {
    const std::vector<std::string_view> cells = cellsOf(line_);
    if (cells.size() != columns_)
      throw QueryError(place() + " has " + std::to_string(cells.size()) + " values, expected " +
                       std::to_string(columns_));
    return {asked(cells, 0), asked(cells, 3)};
  }

  /// Three values, from that column of kTouchColumns on.
  [[nodiscard]] program::AskedPlace asked(const std::vector<std::string_view>& cells,
                                          std::size_t first) const {
    const std::string_view column = kTouchColumns[first];
    program::AskedPlace place{
        this->place() + ", " + std::string(column.substr(0, column.size() - 2)), {}, unit_, true};
    for (std::size_t axis = 0; axis < 3; ++axis) place.numbers[axis] = number(cells, first + axis);
    return place;
  }

  [[nodiscard]] double number(const std::vector<std::string_view>& cells, std::size_t column) const {
    const std::string_view cell = cells[cell_of_[column]];
    double value = 0.0;
    const auto [end, failure] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
    if (failure != std::errc() || end != cell.data() + cell.size() || !std::isfinite(value))
      throw QueryError(place() + ", column " + std::string(kTouchColumns[column]) + ": '" +
                       std::string(cell) + "' is not a finite number");
    return value;
  }

  const std::string& name_;
  std::string_view rest_, line_;
  program::LengthUnit unit_;
  std::size_t number_{0}, columns_{0};
  std::array<std::size_t, kTouchColumns.size()> cell_of_{};  // where each column's value is in a line
};

}  // namespace

std::vector<TouchRow> touchesIn(const std::string& name, std::string_view text,
                                const program::LengthUnit& unit) {
  return TouchReader(name, text, unit).read();
}

std::vector<TouchRow> readTouches(const std::filesystem::path& path, const program::LengthUnit& unit) {
  std::ifstream in(path, std::ios::binary);
  if (!in || std::filesystem::is_directory(path)) throw QueryError(path.string() + ": cannot be read");
  return touchesIn(path.string(), std::string(std::istreambuf_iterator<char>(in), {}), unit);
}

}  // namespace palpate::query
