// SPDX-License-Identifier: Apache-2.0
#include "tools/mesh/read_obj.h"

#include <algorithm>
#include <charconv>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "tools/mesh/byte_reader.h"

namespace palpate::mesh {
namespace {

// Splits off the next word of a line.
std::string_view nextWord(std::string_view& line) {
  const auto begin = std::min(line.find_first_not_of(" \t"), line.size());
  const auto end = std::min(line.find_first_of(" \t", begin), line.size());
  const std::string_view word = line.substr(begin, end - begin);
  line.remove_prefix(end);
  return word;
}

class ObjFile {
 public:
  explicit ObjFile(ByteReader in) : in_(std::move(in)) {}

  TriangleSurface read() {
    while (!in_.rest().empty()) {
      std::string_view line = in_.line();
      line = line.substr(0, line.find('#'));
      const std::string_view keyword = nextWord(line);
      if (keyword == "v") readVertex(line);
      if (keyword == "f") readFace(line);
      if (keyword == "g") changeNames(group_names_, namesIn(line));
      if (keyword == "usemtl") changeNames(material_names_, {std::string(nextWord(line))});
      checkKeyword(keyword);
    }
    dropUnused();
    std::erase_if(surface_.groups, [](const auto& group) { return group.second.empty(); });
    return std::move(surface_);
  }

 private:
  void checkKeyword(std::string_view keyword) const {
    for (const char c : keyword) {
      if (c < ' ' || c > '~') in_.fail("not a text OBJ file");
    }
  }

  void readVertex(std::string_view line) {
    auto& x = surface_.vertices.emplace_back();
    for (Eigen::Index k = 0; k < 3; ++k) {
      const std::string_view word = nextWord(line);
      const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), x[k]);
      if (error != std::errc{} || end != word.data() + word.size()) {
        in_.fail("vertex " + std::to_string(surface_.vertices.size()) +
                 " has a coordinate that is not a number");
      }
    }
  }

  // `7`, `7/1`, `7//3` or `7/1/3`; negative numbers count back from the last vertex.
  std::int32_t corner(std::string_view word) const {
    const auto face = "face " + std::to_string(faces_);
    const std::string_view digits = word.substr(0, word.find('/'));
    std::int64_t number = 0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), number);
    if (error != std::errc{} || end != digits.data() + digits.size())
      in_.fail(face + " has a corner that is not a number");
    const auto vertices = static_cast<std::int64_t>(surface_.vertices.size());
    const std::int64_t index = number < 0 ? vertices + number : number - 1;
    if (index < 0 || index >= vertices) {
      in_.fail(face + " refers to vertex " + std::to_string(number) + ", but there are " +
               std::to_string(vertices) + " so far");
    }
    return static_cast<std::int32_t>(index);
  }

  std::vector<std::string> namesIn(std::string_view line) const {
    constexpr std::size_t kMost = 16;  // as many groups as no file gives one face
    std::vector<std::string> names;
    for (auto word = nextWord(line); !word.empty(); word = nextWord(line)) names.emplace_back(word);
    if (names.size() > kMost)
      in_.fail("face " + std::to_string(faces_ + 1) + " is in " + std::to_string(names.size()) +
               " groups, expected at most " + std::to_string(kMost));
    return names;
  }

  // The groups of the faces that follow: those of the last `g` and of the last `usemtl`.
  void changeNames(std::vector<std::string>& changed, std::vector<std::string> names) {
    changed = std::move(names);
    painted_.clear();
    for (const auto* all : {&group_names_, &material_names_})
      for (const std::string& name : *all)
        if (!name.empty()) painted_.insert(&surface_.groups[name]);
  }

  void readFace(std::string_view line) {
    ++faces_;
    std::vector<std::int32_t> corners;
    for (auto word = nextWord(line); !word.empty(); word = nextWord(line)) corners.push_back(corner(word));
    if (corners.size() < 3)
      in_.fail("face " + std::to_string(faces_) + " has " + std::to_string(corners.size()) + " corners");
    for (std::size_t i = 2; i < corners.size(); ++i) {
      for (auto* group : painted_) group->push_back(static_cast<std::int32_t>(surface_.triangles.size()));
      surface_.triangles.push_back({corners[0], corners[i - 1], corners[i]});
      surface_.triangle_tags.push_back(faces_);
    }
  }

  void dropUnused() {
    std::vector<std::int32_t> kept(surface_.vertices.size(), -1);
    for (const auto& t : surface_.triangles) {
      for (const auto v : t) kept[static_cast<std::size_t>(v)] = 0;
    }
    std::vector<Eigen::Vector3d> vertices;
    for (std::size_t i = 0; i < kept.size(); ++i) {
      if (kept[i] < 0) continue;
      kept[i] = static_cast<std::int32_t>(vertices.size());
      vertices.push_back(surface_.vertices[i]);
      surface_.vertex_tags.push_back(static_cast<std::int64_t>(i + 1));
    }
    surface_.vertices = std::move(vertices);
    for (auto& t : surface_.triangles) {
      for (auto& v : t) v = kept[static_cast<std::size_t>(v)];
    }
  }

  ByteReader in_;
  TriangleSurface surface_;
  std::vector<std::string> group_names_, material_names_;
  std::set<std::vector<std::int32_t>*> painted_;  // the groups of the next face
  std::int64_t faces_{0};
};

}  // namespace

TriangleSurface readObj(ByteReader in) {
  return ObjFile(std::move(in)).read();
}

}  // namespace palpate::mesh
