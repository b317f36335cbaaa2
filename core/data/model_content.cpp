// SPDX-License-Identifier: Apache-2.0
#include "core/data/model_content.h"

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <limits>
#include <span>

#include "core/base/multi_index.h"

namespace palpate {

namespace {

static_assert(std::endian::native == std::endian::little, "the digest is that of little-endian numbers");

const char* typeName(double) {
  return "f64";
}
const char* typeName(float) {
  return "f32";
}
const char* typeName(std::int16_t) {
  return "i16";
}
const char* typeName(std::int32_t) {
  return "i32";
}
const char* typeName(std::int64_t) {
  return "i64";
}
const char* typeName(std::uint8_t) {
  return "u8";
}
const char* typeName(const RegionName&) {
  return "text64";
}

bool fitInOneByte(const WholeNumbers& values) {
  using Byte = std::numeric_limits<std::int8_t>;
  const std::span<const std::int16_t> numbers(values.int16(), values.int8() != nullptr ? 0 : values.size());
  return std::all_of(numbers.begin(), numbers.end(),
                     [](std::int16_t number) { return number >= Byte::min() && number <= Byte::max(); });
}

/// Adds one part after the other: a line that says how many bytes follow, then these.
class ContentHash {
 public:
  template <class T>
  void add(const std::string& name, const char* type, const std::vector<std::uint64_t>& shape,
           std::span<const T> values) {
    begin(name, type, shape);
    hash_.add(std::as_bytes(values));
  }
  /// Of one byte each where that holds all of them, however the file has them.
  void add(const std::string& name, const char* type, const std::vector<std::uint64_t>& shape,
           const WholeNumbers& values) {
    if (!fitInOneByte(values)) return add(name, type, shape, std::span(values.int16(), values.size()));
    begin(name, "i8", shape);
    if (values.int8() != nullptr) return hash_.add(values.asBytes());
    std::array<std::int8_t, 2048> some{};  // less than Sha256::kCopied, since it is gone when the page looks
    static_assert(sizeof some < Sha256::kCopied);
    for (std::size_t i = 0; i < values.size(); i += some.size()) {
      const std::size_t count = std::min(some.size(), values.size() - i);
      for (std::size_t k = 0; k < count; ++k) some[k] = static_cast<std::int8_t>(values[i + k]);
      hash_.add(std::as_bytes(std::span<const std::int8_t>(some).first(count)));
    }
  }
  void operator()(const char* name, const std::string& text) {
    add(name, "text", {text.size()}, std::span<const char>(text));
  }
  void operator()(const char* name, const std::array<double, 3>& values) {
    add(name, "f64", {values.size()}, std::span<const double>(values));
  }
  template <class T>
  void operator()(const char* name, T value) {
    add(name, typeName(value), {}, std::span<const T>(&value, 1));
  }
  [[nodiscard]] Digest finish() { return hash_.finish(); }

 private:
  void begin(std::string line, const char* type, const std::vector<std::uint64_t>& shape) {
    (line += ' ') += type;
    for (const std::uint64_t length : shape) line += ' ' + std::to_string(length);
    line += '\n';
    hash_.add(std::as_bytes(std::span<const char>(line)));
  }

  Sha256 hash_;
};

std::uint64_t lengthOf(std::string_view symbol, const LengthTable& lengths) {
  std::uint64_t number = 0;
  const auto [end, error] = std::from_chars(symbol.data(), symbol.data() + symbol.size(), number);
  return error == std::errc() && end == symbol.data() + symbol.size() ? number : lengths.at(symbol);
}

}  // namespace

LengthTable lengthsOf(const ModelAttributes& a, const ModelView& v) {
  const auto sizeOf = [](int order) { return static_cast<std::uint64_t>(MonomialBasis::size(order)); };
  const bool level = a.parameters == Parameters::kLevel;
  const std::uint64_t Ns = v.surfaceNodes(), M = v.positions();
  const std::uint64_t C = level ? v.level_functions : sizeOf(a.order);
  LengthTable size{{"Ns", Ns},
                   {"3 Ns", 3 * Ns},
                   {"T", v.triangles()},
                   {"Tc", v.contact_triangles.size() / 3},
                   {"R", v.region_name.size()},
                   {"S", v.spring_node.size()},
                   {"M", M},
                   {"M + 1", M + 1},
                   {"C", C},
                   {"n", v.modes()},
                   {"nY", v.positionModes()},
                   {"sum K", v.near_node.size()},
                   {"3 Cm sum K", v.near_field.size()},
                   {"N", v.mesh_node_tag.size()},
                   {"V", v.mesh_tetrahedron_tag.size()},
                   {"F", v.mesh_fixed.size()}};
  if (level) size["L + 1"] = C == 0 ? 0 : v.levels_Z.size() / C;
  size["Cm"] = modeCoefficients(a, C);
  if (a.parameters != Parameters::kDisplacement) return size;
  size["Cf"] = sizeOf(a.force_order);
  size["P"] = v.places();
  size["G"] = v.green_node.size();
  size["G + 1"] = v.green_offset.size();
  size["sum Kg"] = v.green_near_node.size();
  if (v.edge_offset.empty()) return size;
  size["E"] = v.edge_offset.size() - 1;
  size["E + 1"] = v.edge_offset.size();
  size["Ce"] = size["E"] == 0 ? 0 : v.edge_scale.size() / size["E"];
  size["sum Ke"] = v.edge_node.size();
  size["3 Ce sum Ke"] = v.edge_field.size();
  return size;
}

std::vector<std::uint64_t> shapeOf(const std::array<const char*, 4>& shape, const LengthTable& lengths) {
  std::vector<std::uint64_t> numbers;
  for (const char* symbol : shape)
    if (symbol != nullptr) numbers.push_back(lengthOf(symbol, lengths));
  return numbers;
}

Digest contentDigest(const ModelAttributes& a, const ModelView& v) {
  const LengthTable lengths = lengthsOf(a, v);
  ContentHash hash;
  forEachAttribute(a, hash);
  forEachDataset(a, v, [&]<class T>(const Dataset<T>& what, const auto& values) {
    hash.add(what.name(), typeName(T{}), shapeOf(what.shape, lengths), values);
  });
  return hash.finish();
}

}  // namespace palpate
