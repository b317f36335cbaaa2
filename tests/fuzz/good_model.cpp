// SPDX-License-Identifier: Apache-2.0
#include "good_model.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <span>
#include <type_traits>

#include "core/base/multi_index.h"
#include "core/data/model_content.h"

namespace palpate::fuzz {

namespace {

constexpr std::size_t kQuadratic = 1, kLevel = 3;
constexpr int kOrder = 2;
constexpr std::array<std::array<std::int32_t, 3>, 4> kFaces{{{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}}};

template <class T>
constexpr NumberType typeOf() {
  if constexpr (std::is_same_v<T, double>) return NumberType::kF64;
  if constexpr (std::is_same_v<T, float>) return NumberType::kF32;
  if constexpr (std::is_same_v<T, std::int16_t>) return NumberType::kI16;
  if constexpr (std::is_same_v<T, std::int32_t>) return NumberType::kI32;
  if constexpr (std::is_same_v<T, std::int64_t>) return NumberType::kI64;
  if constexpr (std::is_same_v<T, std::uint8_t>) return NumberType::kU8;
  if constexpr (std::is_same_v<T, RegionName>) return NumberType::kRegionName;
}

LengthTable lengthsOf(std::size_t kind) {
  const bool quadratic = kind == kQuadratic, displacement = kind <= kQuadratic;
  const std::uint64_t Ns = quadratic ? 10 : 4, M = 4, E = 6, n = 2, near = displacement ? M : 0;
  const auto C = kind == kLevel ? 2 : static_cast<std::uint64_t>(MonomialBasis::size(kOrder));
  const std::uint64_t Cm = displacement ? C - 3 : C;
  return {{"Ns", Ns},
          {"3 Ns", 3 * Ns},
          {"T", quadratic ? 16 : 4},
          {"Tc", 4},
          {"M", M},
          {"M + 1", M + 1},
          {"C", C},
          {"Cf", C},
          {"Cm", Cm},
          {"P", M + E},
          {"E", E},
          {"E + 1", E + 1},
          {"Ce", C - 3},
          {"n", n},
          {"nY", n},
          {"sum K", near},
          {"3 Cm sum K", 3 * Cm * near},
          {"G", M},
          {"G + 1", M + 1},
          {"sum Kg", M},
          {"sum Ke", E},
          {"3 Ce sum Ke", 3 * (C - 3) * E},
          {"L + 1", 4},
          {"N", Ns},
          {"V", 1},
          {"F", 1},
          {"R", 1},
          {"S", 1}};
}

/// The node in the middle of an edge of the tetrahedron.
std::int32_t middle(std::int32_t a, std::int32_t b) {
  constexpr std::array<std::array<std::int32_t, 4>, 4> kMiddle{
      {{-1, 4, 5, 6}, {4, -1, 7, 8}, {5, 7, -1, 9}, {6, 8, 9, -1}}};
  return kMiddle[static_cast<std::size_t>(a)][static_cast<std::size_t>(b)];
}

std::vector<std::int32_t> cornersOf(bool quadratic) {
  std::vector<std::int32_t> corners;
  for (const auto& [a, b, c] : kFaces) {
    const std::int32_t bc = middle(b, c), ca = middle(c, a), ab = middle(a, b);
    if (quadratic)
      corners.insert(corners.end(), {a, ab, ca, ab, b, bc, ca, bc, c, bc, ca, ab});
    else
      corners.insert(corners.end(), {a, b, c});
  }
  return corners;
}

std::vector<double> points(bool quadratic) {
  std::vector<std::array<double, 3>> nodes{{0, 0, 0}, {0.1, 0, 0}, {0, 0.1, 0}, {0, 0, 0.1}};
  for (std::size_t a = 0; quadratic && a < 4; ++a)
    for (std::size_t b = a + 1; b < 4; ++b) {
      auto& at = nodes.emplace_back();
      for (std::size_t k = 0; k < 3; ++k) at[k] = 0.5 * (nodes[a][k] + nodes[b][k]);
    }
  std::vector<double> numbers;
  for (const auto& node : nodes) numbers.insert(numbers.end(), node.begin(), node.end());
  return numbers;
}

template <class T>
void set(GoodModel& model, const Dataset<T>& what, const std::vector<T>& values) {
  std::vector<std::uint8_t>& bytes = model.arrays.at(what.path).bytes;
  std::memcpy(bytes.data(), values.data(), std::min(bytes.size(), values.size() * sizeof(T)));
}

/// 0, 1, 2 ... as many as the array has.
template <class T>
void count(GoodModel& model, const Dataset<T>& what) {
  std::vector<T> values(model.arrays.at(what.path).bytes.size() / sizeof(T));
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<T>(i);
  set(model, what, values);
}

void fillIndices(GoodModel& model, std::size_t kind) {
  const bool quadratic = kind == kQuadratic;
  set(model, dataset::kSurfacePositions, points(quadratic));
  set(model, dataset::kMeshNodes, points(quadratic));
  set(model, dataset::kSurfaceTriangles, cornersOf(quadratic));
  set(model, dataset::kContactTriangles, cornersOf(false));
  set(model, dataset::kPositionOfNode, {0, 1, 2, 3, -1, -1, -1, -1, -1, -1});
  set(model, dataset::kMeshTetrahedra, {0, 1, 2, 3});
  count(model, dataset::kContactNode);
  count(model, dataset::kMeshSurfaceNode);
  set(model, dataset::kRegionName, {regionName("nodule")});
  set(model, dataset::kRegionLaw, {regionName("stvk")});
  set(model, dataset::kRegionNu, {0.3});
  set(model, dataset::kElementRegion, {0});
  if (kind <= kQuadratic) {
    count(model, dataset::kNearOffset);
    count(model, dataset::kGreenNode);
    count(model, dataset::kGreenOffset);
    count(model, dataset::kEdgeOffset);
  } else {
    set(model, dataset::kNearOffset, {0, 0, 0, 0, 0});
  }
  if (quadratic) set(model, dataset::kMeshMidsides, {4, 7, 5, 6, 8, 9});
  if (kind != kLevel) return;
  set(model, dataset::kLevelsZ, {0.0, 0.1, 0.2, 0.3, 0.0, 0.2, 0.4, 0.6});
}

}  // namespace

GoodModel goodModel(std::size_t kind) {
  const bool displacement = kind <= kQuadratic;
  ModelAttributes a;
  a.parameters = displacement     ? Parameters::kDisplacement
                 : kind == kLevel ? Parameters::kLevel
                                  : Parameters::kForce;
  a.law = "stvk";
  a.E = 1e5;
  a.nu = 0.4;
  a.patch_radius = 0.01;
  a.near_radius = displacement ? 0.02 : 0.0;
  a.reference_displacement = 0.005;
  a.order = a.force_order = kOrder;
  a.reference_force = a.load = 1.0;
  a.load_direction = {1.0, 0.0, 0.0};
  GoodModel model;
  forEachAttribute(a, [&](const char* name, const auto& value) {
    using T = std::decay_t<decltype(value)>;
    if constexpr (std::is_same_v<T, std::string>)
      model.attributes[name] = value;
    else if constexpr (std::is_arithmetic_v<T>)
      model.attributes[name] = std::vector<double>{static_cast<double>(value)};
    else
      model.attributes[name] = std::vector<double>(value.begin(), value.end());
  });
  for (const char* name :
       {"provenance", "digest", "provenance_digest", "certificate", "certificate_digest", "certificate_of"})
    model.attributes[name] = std::string("{}");

  ModelView v;  // what is optional is there
  constexpr std::array<std::int64_t, 1> kSome{};
  constexpr std::array<std::int32_t, 1> kNode{};
  constexpr std::array<RegionName, 1> kName{};
  if (displacement) v.edge_offset = kSome;
  if (kind == kQuadratic) v.mesh_midsides = kNode;
  v.spring_node = kNode;
  v.region_name = kName;
  const LengthTable lengths = lengthsOf(kind);
  forEachDataset(a, v, [&]<class T>(const Dataset<T>& what, const auto&) {
    GoodModel::Array& array = model.arrays[what.path];
    array.type = typeOf<T>();
    array.shape = shapeOf(what.shape, lengths);
    std::size_t numbers = 1;
    for (const std::uint64_t length : array.shape) numbers *= length;
    std::vector<T> values(numbers);
    if constexpr (std::is_floating_point_v<T>) std::fill(values.begin(), values.end(), T(0.25));
    array.bytes.resize(numbers * sizeof(T));
    if (numbers > 0) std::memcpy(array.bytes.data(), values.data(), array.bytes.size());
  });
  fillIndices(model, kind);
  return model;
}

}  // namespace palpate::fuzz
