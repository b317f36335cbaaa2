// SPDX-License-Identifier: Apache-2.0
#include "tools/mesh/read_vtk.h"

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "tools/mesh/byte_reader.h"

namespace palpate::mesh {
namespace {

constexpr int kTetrahedron = 10, kQuadratic = 24;
constexpr std::int64_t kMaxCorners = 1 << 20;  // of one cell; more is a corrupt count

// Reads a legacy VTK file: https://docs.vtk.org, "VTK legacy file format". Binary data are big-endian.
class VtkFile {
 public:
  explicit VtkFile(ByteReader in) : in_(std::move(in)) {
    constexpr std::uint16_t kOne = 1;
    in_.swapBytes(*reinterpret_cast<const unsigned char*>(&kOne) == 1);
  }

  RawMesh read() {
    readHead();
    while (!in_.atEnd() && readSection(std::string(in_.word("a keyword")))) in_.setBinary(false);
    keepTetrahedra();
    return std::move(mesh_);
  }

 private:
  void readHead() {
    const std::string version(in_.line());
    static const std::string kMagic = "# vtk DataFile Version ";
    if (!version.starts_with(kMagic))
      in_.fail("not a legacy VTK file: the first line is not '# vtk DataFile Version ..'");
    offsets_ = version.substr(kMagic.size()).starts_with('5');
    in_.line();  // the title
    const std::string coding(in_.word("ASCII or BINARY"));
    if (coding != "ASCII" && coding != "BINARY")
      in_.fail("'" + coding.substr(0, 20) + "' is neither ASCII nor BINARY");
    coded_binary_ = coding == "BINARY";
    if (in_.word("DATASET") != "DATASET") in_.fail("the third section is not DATASET");
    const std::string dataset(in_.word("the dataset's type"));
    if (dataset != "UNSTRUCTURED_GRID") {
      in_.fail("the dataset is " + dataset.substr(0, 30) + ", expected UNSTRUCTURED_GRID (a volume mesh)");
    }
  }

  // False at the data on cells and points, which come last and are skipped.
  bool readSection(const std::string& keyword) {
    if (keyword == "CELL_DATA" || keyword == "POINT_DATA") return false;
    if (keyword == "POINTS") {
      readPoints();
    } else if (keyword == "CELLS") {
      offsets_ ? readCells5() : readCells();
    } else if (keyword == "CELL_TYPES") {
      readTypes();
    } else if (keyword == "FIELD") {
      skipField();
    } else if (keyword == "METADATA") {
      in_.line();
      while (!in_.rest().empty() && !in_.line().empty()) continue;
    } else {
      in_.fail("'" + keyword.substr(0, 30) + "' is not a section of an unstructured grid");
    }
    return true;
  }

  // Bytes of a number of this type in a binary file.
  std::size_t width(const std::string& type) const {
    static const std::map<std::string, std::size_t> kWidths{
        {"unsigned_char", 1}, {"char", 1}, {"unsigned_short", 2}, {"short", 2},
        {"unsigned_int", 4},  {"int", 4},  {"float", 4},          {"vtktypeint32", 4},
        {"unsigned_long", 8}, {"long", 8}, {"double", 8},         {"vtktypeint64", 8}};
    const auto found = kWidths.find(type);
    if (found == kWidths.end()) in_.fail("data type '" + type.substr(0, 20) + "' is not known");
    return found->second;
  }

  std::size_t count(std::size_t bytes_each, const char* what) {
    return in_.checkedCount(in_.textInteger(what), coded_binary_ ? bytes_each : 2, what);
  }

  void startData() {
    in_.line();
    in_.setBinary(coded_binary_);
  }

  void readPoints() {
    const std::size_t points = count(12, "the number of points");
    const std::string type(in_.word("the type of the points"));
    if (type != "float" && type != "double") in_.fail("points are of type '" + type.substr(0, 20) + "'");
    startData();
    const bool narrow = in_.binary() && type == "float";
    for (std::size_t i = 0; i < points; ++i) {
      auto& x = mesh_.points.emplace_back();
      for (Eigen::Index k = 0; k < 3; ++k) {
        x[k] = narrow ? static_cast<double>(in_.raw<float>("a point's coordinate"))
                      : in_.real("a point's coordinate");
      }
      mesh_.point_tags.push_back(static_cast<std::int64_t>(mesh_.points.size()));
    }
  }

  // Each cell: number of corners, corners.
  void readCells() {
    const std::size_t cells = count(4, "the number of cells");
    const std::size_t announced = count(4, "the size of the cells");
    startData();
    std::size_t read = 0;
    for (std::size_t i = 0; i < cells; ++i) {
      const auto corners = in_.integer32("a cell's number of corners");
      if (corners < 0 || corners > kMaxCorners) {
        in_.fail("cell " + std::to_string(i + 1) + " has " + std::to_string(corners) + " corners");
      }
      auto& cell = cells_.emplace_back();
      for (std::int64_t k = 0; k < corners; ++k) cell.push_back(in_.integer32("a cell's corner"));
      read += cell.size() + 1;
    }
    if (read != announced) {
      in_.fail("the cells take " + std::to_string(read) + " numbers, the section announces " +
               std::to_string(announced));
    }
  }

  std::vector<std::int64_t> readArray(const char* name, std::size_t size) {
    if (in_.word(name) != name) in_.fail(std::string("expected ") + name);
    const bool narrow = width(std::string(in_.word("a data type"))) == 4;
    startData();
    std::vector<std::int64_t> numbers(size);
    for (auto& number : numbers) number = narrow ? in_.integer32(name) : in_.integer64(name);
    in_.setBinary(false);
    return numbers;
  }

  // Since version 5: where each cell begins in one list of corners.
  void readCells5() {
    const std::size_t offsets = count(4, "the number of offsets");
    const std::size_t corners = count(4, "the number of corners");
    const auto begin = readArray("OFFSETS", offsets);
    const auto nodes = readArray("CONNECTIVITY", corners);
    for (std::size_t i = 0; i + 1 < begin.size(); ++i) {
      if (begin[i] < 0 || begin[i + 1] < begin[i] || begin[i + 1] > static_cast<std::int64_t>(nodes.size())) {
        in_.fail("the offsets of cell " + std::to_string(i + 1) + " are out of range");
      }
      cells_.emplace_back(nodes.begin() + begin[i], nodes.begin() + begin[i + 1]);
    }
  }

  void readTypes() {
    const std::size_t types = count(4, "the number of cell types");
    startData();
    for (std::size_t i = 0; i < types; ++i) types_.push_back(in_.integer32("a cell's type"));
  }

  void skipField() {
    in_.word("a field's name");
    const std::size_t arrays = count(1, "the number of arrays in a field");
    for (std::size_t a = 0; a < arrays; ++a) {
      in_.word("an array's name");
      const std::size_t components = count(1, "an array's number of components");
      const std::size_t tuples = count(1, "an array's number of tuples");
      const std::string type(in_.word("an array's type"));
      if (components != 0 && tuples > in_.rest().size() / components)
        in_.fail("an array is longer than the file");
      const std::size_t numbers = components * tuples;
      if (!coded_binary_) {
        for (std::size_t i = 0; i < numbers; ++i) in_.word("a number of an array");
        continue;
      }
      in_.line();
      in_.skip(numbers * width(type), "an array");
    }
  }

  void keepTetrahedra() {
    if (types_.size() != cells_.size()) {
      in_.fail("there are " + std::to_string(cells_.size()) + " cells and " + std::to_string(types_.size()) +
               " cell types");
    }
    for (std::size_t i = 0; i < cells_.size(); ++i) {
      const std::string name = "cell " + std::to_string(i + 1);
      const auto type = types_[i];
      const bool flat = (type >= 1 && type <= 9) || (type >= 21 && type <= 23) || type == 28 || type == 30 ||
                        (type >= 34 && type <= 36);
      if (flat) continue;
      if (type != kTetrahedron && type != kQuadratic) {
        in_.fail(name + " is of VTK type " + std::to_string(type) +
                 "; of volume cells only tetrahedra of 4 and 10 nodes (types 10 and 24) are taken");
      }
      if (cells_[i].size() != (type == kTetrahedron ? 4U : 10U))
        in_.fail(name + " is a tetrahedron of type " + std::to_string(type) + " with " +
                 std::to_string(cells_[i].size()) + " nodes");
      for (auto& node : cells_[i]) ++node;  // points are numbered from 1
      mesh_.tetrahedra.push_back({static_cast<std::int64_t>(i + 1), std::move(cells_[i]), {}});
    }
  }

  ByteReader in_;
  RawMesh mesh_;
  std::vector<std::vector<std::int64_t>> cells_;
  std::vector<std::int64_t> types_;
  bool coded_binary_{false};
  bool offsets_{false};
};

}  // namespace

RawMesh readVtk(ByteReader in) {
  return VtkFile(std::move(in)).read();
}

}  // namespace palpate::mesh
