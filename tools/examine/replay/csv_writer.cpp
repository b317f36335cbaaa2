// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <fstream>

#include "tools/examine/replay/table_writer.h"
#include "tools/program/write_file.h"

namespace palpate::replay {
namespace {

class CsvWriter : public TableWriter {
 public:
  explicit CsvWriter(const std::filesystem::path& path) : path_(path), beside_(path), file_(beside_.path()) {
    if (!file_) throw program::WriteError(path_, std::strerror(errno));
    const record::RecordedTick none;
    forEachColumn({none, 0, 0, false},
                  [&](const char* name, const char*, const char*, auto) { put(name, std::strlen(name)); });
    endLine();
  }

  void add(const TableRow& row) override {
    forEachColumn(row, [&](const char*, const char*, const char*, auto value) {
      std::array<char, 32> text;  // the shortest that reads as the same number
      const auto end = std::to_chars(text.data(), text.data() + text.size(), value).ptr;
      put(text.data(), static_cast<std::size_t>(end - text.data()));
    });
    endLine();
  }

  void finish() override {
    file_.close();
    if (!file_) throw program::WriteError(path_, std::strerror(errno));
    beside_.takePlace();
  }

 private:
  void put(const char* text, std::size_t size) {
    if (!first_) file_.put(',');
    first_ = false;
    file_.write(text, static_cast<std::streamsize>(size));
  }
  void endLine() {
    file_.put('\n');
    first_ = true;
    if (!file_) throw program::WriteError(path_, std::strerror(errno));
  }

  std::filesystem::path path_;
  program::FileBeside beside_;
  std::ofstream file_;
  bool first_{true};  // in its line
};

}  // namespace

std::unique_ptr<TableWriter> csvWriter(const std::filesystem::path& path) {
  return std::make_unique<CsvWriter>(path);
}

}  // namespace palpate::replay
