// SPDX-License-Identifier: Apache-2.0
#include <hdf5.h>

#include <string>
#include <type_traits>
#include <variant>
#include <vector>

#include "core/data/hdf5_handle.h"
#include "tools/examine/replay/table_writer.h"
#include "tools/program/write_file.h"

namespace palpate::replay {
namespace {

constexpr hsize_t kChunk = 8192;  // rows that are written at a time

template <class T>
hid_t typeOf() {
  if constexpr (std::is_same_v<T, double>) return H5T_NATIVE_DOUBLE;
  if constexpr (std::is_same_v<T, std::int64_t>) return H5T_NATIVE_INT64;
  return H5T_NATIVE_UINT64;
}

class H5Writer : public TableWriter {
 public:
  H5Writer(const std::filesystem::path& path, const record::SessionFacts& facts)
      : path_(path),
        beside_(path),
        file_(H5Fcreate(beside_.path().c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT), H5Fclose) {
    require(file_.valid(), "the file");
    writeText(file_.get(), "model_id", facts.model.id());
    writeText(file_.get(), "engine", facts.engine.text());
    const Hdf5Handle scalar(H5Screate(H5S_SCALAR), H5Sclose);
    const Hdf5Handle started(
        H5Acreate2(file_.get(), "started_ns", H5T_STD_I64LE, scalar.get(), H5P_DEFAULT, H5P_DEFAULT),
        H5Aclose);
    require(started.valid() && H5Awrite(started.get(), H5T_NATIVE_INT64, &facts.started_ns) >= 0,
            "started_ns");
    const record::RecordedTick none;
    forEachColumn({none, 0, 0, false}, [&](const char* name, const char* unit, const char* what, auto value) {
      columns_.push_back(makeColumn<decltype(value)>(name, unit, what));
    });
  }

  void add(const TableRow& row) override {
    std::size_t column = 0;
    forEachColumn(row, [&](const char*, const char*, const char*, auto value) {
      std::get<std::vector<decltype(value)>>(columns_[column++].pending).push_back(value);
    });
    if (++held_ == kChunk) flush();
  }

  void finish() override {
    flush();
    columns_.clear();
    require(file_.closeNow(), "the file");
    beside_.takePlace();
  }

 private:
  struct Column {
    std::string name;
    Hdf5Handle set;
    std::variant<std::vector<std::uint64_t>, std::vector<std::int64_t>, std::vector<double>> pending;
  };

  void require(bool good, const std::string& what) const {
    if (!good) throw program::WriteError(path_, "HDF5 cannot write " + what);
  }

  void writeText(hid_t object, const char* name, const std::string& text) const {
    const Hdf5Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
    const Hdf5Handle scalar(H5Screate(H5S_SCALAR), H5Sclose);
    require(H5Tset_size(type.get(), text.size() + 1) >= 0, name);
    const Hdf5Handle attribute(H5Acreate2(object, name, type.get(), scalar.get(), H5P_DEFAULT, H5P_DEFAULT),
                               H5Aclose);
    require(attribute.valid() && H5Awrite(attribute.get(), type.get(), text.c_str()) >= 0, name);
  }

  template <class T>
  [[nodiscard]] Column makeColumn(const char* name, const char* unit, const char* what) const {
    const hsize_t none = 0, chunk = kChunk, endless = H5S_UNLIMITED;
    const Hdf5Handle space(H5Screate_simple(1, &none, &endless), H5Sclose);
    const Hdf5Handle how(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
    require(H5Pset_chunk(how.get(), 1, &chunk) >= 0 && H5Pset_shuffle(how.get()) >= 0 &&
                H5Pset_deflate(how.get(), 4) >= 0,
            name);
    Column column{
        name,
        {H5Dcreate2(file_.get(), name, typeOf<T>(), space.get(), H5P_DEFAULT, how.get(), H5P_DEFAULT),
         H5Dclose},
        std::vector<T>()};
    require(column.set.valid(), name);
    writeText(column.set.get(), "unit", unit);
    writeText(column.set.get(), "description", what);
    return column;
  }

  void flush() {
    if (held_ == 0) return;
    const hsize_t from = rows_, size = rows_ + held_;
    for (Column& column : columns_) {
      require(H5Dset_extent(column.set.get(), &size) >= 0, column.name);
      const Hdf5Handle space(H5Dget_space(column.set.get()), H5Sclose);
      const Hdf5Handle memory(H5Screate_simple(1, &held_, nullptr), H5Sclose);
      require(H5Sselect_hyperslab(space.get(), H5S_SELECT_SET, &from, nullptr, &held_, nullptr) >= 0,
              column.name);
      std::visit(
          [&]<class T>(std::vector<T>& values) {
            require(H5Dwrite(column.set.get(), typeOf<T>(), memory.get(), space.get(), H5P_DEFAULT,
                             values.data()) >= 0,
                    column.name);
            values.clear();
          },
          column.pending);
    }
    rows_ = size;
    held_ = 0;
  }

  std::filesystem::path path_;
  program::FileBeside beside_;
  Hdf5Handle file_;
  std::vector<Column> columns_;
  hsize_t rows_{0};  // in the file
  hsize_t held_{0};  // pending
};

}  // namespace

std::unique_ptr<TableWriter> h5Writer(const std::filesystem::path& path, const record::SessionFacts& facts) {
  return std::make_unique<H5Writer>(path, facts);
}

}  // namespace palpate::replay
