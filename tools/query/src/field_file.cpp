// SPDX-License-Identifier: Apache-2.0
#include "palpate/query/field_file.h"

#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <functional>
#include <sstream>

#include "palpate/query/query_error.h"

namespace palpate::query {

namespace {

class Vtu {
 public:
  Vtu() { out_.precision(17); }

  void open(const std::string& tag) { out_ << '<' << tag << ">\n"; }

  /// One entry a line. @param attributes  of the DataArray
  template <typename T>
  void array(const std::string& attributes, std::size_t rows, std::size_t columns,
             const std::function<T(std::size_t row, std::size_t column)>& at) {
    out_ << "<DataArray format=\"ascii\" " << attributes << ">\n";
    for (std::size_t row = 0; row < rows; ++row)
      for (std::size_t column = 0; column < columns; ++column)
        out_ << at(row, column) << (column + 1 < columns ? ' ' : '\n');
    out_ << "</DataArray>\n";
  }
  void vectors(const std::string& name, std::size_t rows,
               const std::function<double(std::size_t row, std::size_t axis)>& at) {
    array<double>("type=\"Float64\" NumberOfComponents=\"3\" Name=\"" + name + "\"", rows, 3, at);
  }
  [[nodiscard]] std::string text() const { return out_.str(); }

 private:
  std::ostringstream out_;
};

void addGeometry(Vtu& vtu, const ModelView& view) {
  vtu.open("Points");
  vtu.vectors("Points", view.surfaceNodes(),
              [&](std::size_t i, std::size_t axis) { return view.surface_positions[3 * i + axis]; });
  vtu.open("/Points");
  vtu.open("Cells");
  vtu.array<std::int32_t>("type=\"Int32\" Name=\"connectivity\"", view.triangles(), 3,
                          [&](std::size_t t, std::size_t k) { return view.surface_triangles[3 * t + k]; });
  vtu.array<std::size_t>("type=\"Int32\" Name=\"offsets\"", view.triangles(), 1,
                         [](std::size_t t, std::size_t) { return 3 * (t + 1); });
  vtu.array<int>("type=\"UInt8\" Name=\"types\"", view.triangles(), 1,
                 [](std::size_t, std::size_t) { return 5; });
  vtu.open("/Cells");
}

void addData(Vtu& vtu, const ModelView& view, const Answer& answer, const Organ* organ,
             const FullSolution* truth) {
  const auto model_u = [&](std::size_t i, std::size_t axis) {
    return static_cast<double>(answer.field[3 * i + axis]);
  };
  vtu.open("PointData Vectors=\"displacement\"");
  vtu.vectors("displacement", view.surfaceNodes(), model_u);
  if (truth != nullptr) {
    const auto full_u = [&](std::size_t i, std::size_t axis) {
      return truth->displacement(*organ, static_cast<int>(i))[static_cast<Eigen::Index>(axis)];
    };
    vtu.vectors("newton", view.surfaceNodes(), full_u);
    vtu.vectors("error", view.surfaceNodes(),
                [&](std::size_t i, std::size_t axis) { return model_u(i, axis) - full_u(i, axis); });
  }
  vtu.array<std::int64_t>("type=\"Int64\" Name=\"mesh_tag\"", view.surfaceNodes(), 1,
                          [&](std::size_t i, std::size_t) { return view.surface_mesh_tag[i]; });
  vtu.open("/PointData");
}

}  // namespace

std::string fieldVtu(const MetaModel& model, const Answer& answer, const Organ* organ,
                     const FullSolution* truth) {
  const ModelView& view = model.view();
  Vtu vtu;
  vtu.open("?xml version=\"1.0\"?");
  vtu.open("VTKFile type=\"UnstructuredGrid\" version=\"0.1\"");
  vtu.open("UnstructuredGrid");
  vtu.open("Piece NumberOfPoints=\"" + std::to_string(view.surfaceNodes()) + "\" NumberOfCells=\"" +
           std::to_string(view.triangles()) + "\"");
  addGeometry(vtu, view);
  addData(vtu, view, answer, organ, truth);
  vtu.open("/Piece");
  vtu.open("/UnstructuredGrid");
  vtu.open("/VTKFile");
  return vtu.text();
}

}  // namespace palpate::query
