// SPDX-License-Identifier: Apache-2.0
#include "tools/examine/replay/export_table.h"

#include <gtest/gtest.h>
#include <hdf5.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <sstream>
#include <string>
#include <vector>

#include "core/record/record_writer.h"
#include "palpate/testing/files.h"

namespace palpate::replay {
namespace {

// 9000 ticks, more than an HDF5 chunk; tool 0 from the second tick on with two ticks a pose, tool 2 in the last tick.
class ExportTable : public ::testing::Test {
 protected:
  ExportTable() {
    facts_.started_ns = 1'700'000'000'000'000'000;
    record::RecordedTick tick;
    for (std::uint64_t i = 0; i < 9000; ++i) {
      tick.index = i;
      tick.input.dt_ns = i == 0 ? 0 : 1'000'000;
      tick.woke_ns = 5'000'000'000 + static_cast<std::int64_t>(i) * 1'000'000;
      tick.input.tools[0].present = i > 0 ? 1 : 0;
      tick.input.tools[0].position = {0.1 + 1e-6 * static_cast<double>(i), -0.0, std::nan("")};
      if (i % 2 == 1) tick.poses[0] = {i, -7, tick.woke_ns - 250'000, 5};
      tick.result.tools[0].force = {0.0, 0.0, 1e-3 * static_cast<double>(i)};
      tick.result.tools[0].flags = 1;
      tick.result.tools[0].state = 2;
      tick.result.tools[0].proxy = {1.0, 2.0, 3.0};
      ticks_.push_back(tick);
    }
    ticks_.back().input.tools[2].present = 1;
    ticks_.back().poses[2].seq = std::numeric_limits<std::uint64_t>::max();
  }

  TableSize written(const std::string& format, Demand demand = Demand::kWhole, std::uint64_t lost = 0,
                    bool end = true) const {
    {
      record::RecordWriter writer(recording_.path(), facts_);
      for (const record::RecordedTick& tick : ticks_) writer.write(tick);
      end ? writer.finish(ticks_.size() + lost) : writer.flush();
    }
    record::RecordReader reader(recording_.path());
    return exportTable(reader, format, table_.path(), demand);
  }

  record::SessionFacts facts_;
  std::vector<record::RecordedTick> ticks_;
  palpate::testing::TemporaryFile recording_{"export.rec"};
  palpate::testing::TemporaryFile table_{"export-table"};
};

std::vector<std::string> parted(const std::string& line) {
  std::vector<std::string> cells;
  std::istringstream text(line);
  for (std::string cell; std::getline(text, cell, ',');) cells.push_back(cell);
  return cells;
}

TEST_F(ExportTable, HasARowForEachTickAndTool) {
  const TableSize size = written("csv");
  EXPECT_EQ(size.rows, 9000U) << "8999 of tool 0, one of tool 2";
  EXPECT_EQ(size.ticks, 9000U);
  std::ifstream file(table_.path());
  std::string line;
  std::getline(file, line);
  const std::vector<std::string> names = parted(line);
  EXPECT_EQ(names.size(), 27U);
  const auto cell = [&](const std::vector<std::string>& row, const std::string& name) {
    return row.at(static_cast<std::size_t>(std::find(names.begin(), names.end(), name) - names.begin()));
  };
  std::getline(file, line);
  const auto first = parted(line);
  ASSERT_EQ(first.size(), names.size()) << line;
  EXPECT_EQ(cell(first, "tick"), "1");
  EXPECT_EQ(cell(first, "time_s"), "0.001");
  EXPECT_EQ(cell(first, "tool"), "0");
  EXPECT_EQ(cell(first, "new_pose"), "1");
  EXPECT_EQ(cell(first, "pose_stamp_ns"), "-7");
  EXPECT_DOUBLE_EQ(std::stod(cell(first, "pose_arrival_s")), 0.00075);
  EXPECT_EQ(cell(first, "buttons"), "5");
  EXPECT_EQ(std::stod(cell(first, "position_x_m")), 0.1 + 1e-6) << "the same number again";
  EXPECT_EQ(cell(first, "position_y_m"), "-0");
  EXPECT_EQ(cell(first, "position_z_m"), "nan");
  EXPECT_EQ(cell(first, "orientation_w"), "1");
  EXPECT_EQ(cell(first, "force_z_N"), "0.001");
  EXPECT_EQ(cell(first, "state"), "2");
  EXPECT_EQ(cell(first, "proxy_z_m"), "3");
  std::getline(file, line);
  EXPECT_EQ(cell(parted(line), "new_pose"), "0") << "the same pose again";
  std::size_t rows = 2;
  for (std::string next; std::getline(file, next); ++rows) line = next;
  EXPECT_EQ(rows, 9000U);
  EXPECT_EQ(cell(parted(line), "tool"), "2");
  EXPECT_EQ(cell(parted(line), "pose_seq"), "18446744073709551615");
}

class Hdf5File {
 public:
  explicit Hdf5File(const std::filesystem::path& path)
      : id_(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT)) {}
  ~Hdf5File() { H5Fclose(id_); }
  Hdf5File(const Hdf5File&) = delete;
  Hdf5File& operator=(const Hdf5File&) = delete;

  template <class T>
  [[nodiscard]] std::vector<T> column(const char* name, hid_t type) const {
    const hid_t set = H5Dopen2(id_, name, H5P_DEFAULT), space = H5Dget_space(set);
    std::vector<T> values(static_cast<std::size_t>(H5Sget_simple_extent_npoints(space)));
    EXPECT_GE(H5Dread(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()), 0) << name;
    H5Sclose(space);
    H5Dclose(set);
    return values;
  }
  [[nodiscard]] std::string text(const char* object, const char* name) const {
    const hid_t attribute = H5Aopen_by_name(id_, object, name, H5P_DEFAULT, H5P_DEFAULT),
                type = H5Aget_type(attribute);
    std::string text(H5Tget_size(type), '\0');
    EXPECT_GE(H5Aread(attribute, type, text.data()), 0) << object << ' ' << name;
    H5Tclose(type);
    H5Aclose(attribute);
    return text.c_str();
  }

 private:
  hid_t id_;
};

TEST_F(ExportTable, HasADatasetForEachColumnWithItsUnit) {
  const TableSize size = written("h5");
  const Hdf5File file(table_.path());
  const auto force = file.column<double>("force_z_N", H5T_NATIVE_DOUBLE);
  ASSERT_EQ(force.size(), size.rows);
  for (std::size_t i = 0; i < 8999; ++i) ASSERT_EQ(force[i], 1e-3 * static_cast<double>(i + 1)) << i;
  EXPECT_EQ(file.column<std::uint64_t>("pose_seq", H5T_NATIVE_UINT64).back(),
            std::numeric_limits<std::uint64_t>::max());
  EXPECT_EQ(file.column<std::int64_t>("pose_stamp_ns", H5T_NATIVE_INT64).front(), -7);
  EXPECT_EQ(file.text("force_z_N", "unit"), "N");
  EXPECT_EQ(file.text("time_s", "unit"), "s");
  EXPECT_EQ(file.text("/", "model_id"), facts_.model.id());
  EXPECT_EQ(file.text("/", "engine"), facts_.engine.text());
}

TEST_F(ExportTable, RefusesWhatIsNotWholeUnlessToldThatItMayBe) {
  for (const char* format : {"csv", "h5"}) {
    EXPECT_THROW((void)written(format, Demand::kWhole, 3), record::RecordError);
    EXPECT_FALSE(std::filesystem::exists(table_.path())) << "no half of a table";
    EXPECT_THROW((void)written(format, Demand::kWhole, 0, false), record::TruncatedError);
    EXPECT_FALSE(std::filesystem::exists(table_.path()));
    EXPECT_EQ(written(format, Demand::kPartial, 3).missing, 3U);
    EXPECT_TRUE(written(format, Demand::kPartial, 0, false).truncated);
    std::filesystem::remove(table_.path());
  }
}

TEST_F(ExportTable, SaysWhichFileCannotBeWritten) {
  record::RecordWriter(recording_.path(), facts_).finish(0);
  for (const char* format : {"csv", "h5"}) {
    record::RecordReader reader(recording_.path());
    try {
      (void)exportTable(reader, format, "/nonexistent/table", Demand::kWhole);
      ADD_FAILURE() << format;
    } catch (const std::runtime_error& error) {
      EXPECT_EQ(std::string(error.what()).find("cannot write /nonexistent/table: "), 0U) << error.what();
    }
  }
}

}  // namespace
}  // namespace palpate::replay
