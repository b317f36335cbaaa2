// SPDX-License-Identifier: Apache-2.0
#include "tools/mesh/read_msh.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "tools/mesh/byte_reader.h"
#include "tools/mesh/msh_element.h"
#include "tools/mesh/read_msh4.h"

namespace palpate::mesh {
namespace {

using Tags = std::vector<std::int64_t>;

void readFormat(ByteReader& in, MshFormat& format) {
  const std::string version(in.word("the format version"));
  static constexpr std::array<const char*, 6> kKnown{"2", "2.0", "2.1", "2.2", "4", "4.0"};
  const bool is_41 = version == "4.1";
  if (!is_41 && std::find(kKnown.begin(), kKnown.end(), version) == kKnown.end()) {
    in.fail("Gmsh format version is '" + version.substr(0, 10) + "', expected 1, 2, 4.0 or 4.1");
  }
  format.major = version.front() - '0';
  format.minor = is_41 ? 1 : 0;
  format.binary = in.textInteger("the file type") == 1;
  // Gmsh 4.8 cannot write it either, so no test could cover it.
  if (format.binary && version.starts_with("4") && !is_41)
    in.fail("binary files of version 4.0 are not read; save as 4.1");
  const auto width = in.textInteger("the data size");
  if (width != 8) in.fail("the data size is " + std::to_string(width) + ", expected 8");
  if (!format.binary) return;
  in.line();
  const auto one = in.raw<std::int32_t>("the byte order mark");
  if (one != 1 && one != 0x01000000)
    in.fail("the byte order mark is " + std::to_string(one) + ", expected 1");
  in.swapBytes(one != 1);
}

void readNames(ByteReader& in, RawMesh& mesh) {
  const auto count =
      in.checkedCount(in.textInteger("the number of physical names"), 5, "the number of physical names");
  for (std::size_t i = 0; i < count; ++i) {
    const auto dimension = in.textInteger("the dimension of a physical name");
    if (dimension < 0 || dimension > 3)
      in.fail("the dimension of a physical name is " + std::to_string(dimension));
    const auto number = in.textInteger("the number of a physical name");
    const std::string_view line = in.line();
    const auto open = line.find('"');
    const auto close = line.rfind('"');
    if (open == std::string_view::npos || close == open) in.fail("a physical name is not in quotes");
    mesh.group_names[{static_cast<int>(dimension), number}] = line.substr(open + 1, close - open - 1);
  }
}

void readNodes(ByteReader& in, const MshFormat& format, RawMesh& mesh) {
  const auto count = in.checkedCount(in.textInteger("the number of nodes"), 8, "the number of nodes");
  if (format.binary) in.line();
  in.setBinary(format.binary);
  mesh.points.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    mesh.point_tags.push_back(in.integer32("a node's number"));
    auto& x = mesh.points.emplace_back();
    for (Eigen::Index k = 0; k < 3; ++k) x[k] = in.real("a node's coordinate");
  }
}

// Versions 1 and 2 list a tetrahedron once for each of its physical groups, under different numbers. The
// first number stays. checkMesh() refuses a tetrahedron that one group lists twice, or that is listed both in
// a group and without one.
void keepFirstListing(RawMesh& mesh) {
  std::map<Tags, std::size_t> first;
  std::vector<RawMesh::Tetrahedron> kept;
  for (auto& listed : mesh.tetrahedra) {
    const auto [at, is_new] = first.try_emplace(listed.nodes, kept.size());
    Tags* const groups = is_new ? nullptr : &kept[at->second].groups;
    const bool again = groups != nullptr && !groups->empty() && !listed.groups.empty() &&
                       std::count(groups->begin(), groups->end(), listed.groups.front()) == 0;
    if (again) {
      groups->push_back(listed.groups.front());
    } else {
      kept.push_back(std::move(listed));
    }
  }
  mesh.tetrahedra = std::move(kept);
}

// number type physical elementary count nodes...
void readElements1(ByteReader& in, RawMesh& mesh) {
  const auto count = in.checkedCount(in.textInteger("the number of elements"), 12, "the number of elements");
  for (std::size_t i = 0; i < count; ++i) {
    const auto tag = in.textInteger("an element's number");
    const auto type = mshElementType(in, in.textInteger("an element's type"), tag);
    const auto group = in.textInteger("an element's physical number");
    in.textInteger("an element's elementary number");
    const auto nodes = in.textInteger("an element's number of nodes");
    if (nodes != type.nodes) {
      in.fail("element " + std::to_string(tag) + " has " + std::to_string(nodes) + " nodes, its type has " +
              std::to_string(type.nodes));
    }
    readMshElement(in, mesh, false, tag, type, Tags{group});
  }
  keepFirstListing(mesh);
}

// The physical number is the first of the tags.
Tags readTags(ByteReader& in, std::int64_t count) {
  Tags tags;
  if (count < 0 || count > 1000) in.fail("an element has " + std::to_string(count) + " tags");
  for (std::int64_t i = 0; i < count; ++i) {
    const auto tag = in.integer32("an element's tag");
    if (i == 0) tags.push_back(tag);
  }
  return tags;
}

// One element of version 2, whose number of tags is known.
void readElement2(ByteReader& in, RawMesh& mesh, std::int64_t tag, std::int64_t type, std::int64_t tags) {
  const MshElementType known = mshElementType(in, type, tag);
  readMshElement(in, mesh, false, tag, known, readTags(in, tags));
}

void readElements2(ByteReader& in, const MshFormat& format, RawMesh& mesh) {
  const auto count = in.checkedCount(in.textInteger("the number of elements"), 8, "the number of elements");
  if (format.binary) in.line();
  in.setBinary(format.binary);
  for (std::size_t i = 0; i < count;) {
    if (!format.binary) {
      const auto tag = in.textInteger("an element's number");
      const auto type = in.textInteger("an element's type");
      readElement2(in, mesh, tag, type, in.textInteger("an element's number of tags"));
      ++i;
      continue;
    }
    const auto type = in.integer32("an element's type");
    const auto follow = in.integer32("a number of elements");
    const auto tags = in.integer32("an element's number of tags");
    if (follow < 1 || static_cast<std::size_t>(follow) > count - i) {
      in.fail("a block of elements counts " + std::to_string(follow));
    }
    for (std::int64_t k = 0; k < follow; ++k, ++i) {
      const auto tag = in.integer32("an element's number");
      readElement2(in, mesh, tag, type, tags);
    }
  }
  keepFirstListing(mesh);
}

void skipSection(ByteReader& in, const std::string& name) {
  const auto end = in.rest().find("$End" + name.substr(1));
  if (end == std::string_view::npos) in.fail("section " + name.substr(0, 40) + " has no end");
  in.skip(end, "a section");
}

class MshFile {
 public:
  explicit MshFile(ByteReader in) : in_(std::move(in)) {}

  RawMesh read() {
    while (!in_.atEnd()) {
      const std::string name(in_.word("a section"));
      if (name.front() != '$') in_.fail("not a Gmsh mesh: a section starts with $");
      readSection(name);
      in_.setBinary(false);
      const std::string end = (format_.major == 1 ? "$END" : "$End") + name.substr(1);
      if (in_.word(end.c_str()) != end)
        in_.fail("section " + name.substr(0, 40) + " does not end with " + end.substr(0, 40));
    }
    return std::move(mesh_);
  }

 private:
  void readSection(const std::string& name) {
    if (name == "$NOD" || name == "$ELM") {
      format_.major = 1;
      return name == "$NOD" ? readNodes(in_, format_, mesh_) : readElements1(in_, mesh_);
    }
    if (name == "$MeshFormat") return readFormat(in_, format_);
    if (format_.major == 0) in_.fail("section " + name.substr(0, 40) + " comes before $MeshFormat");
    if (name == "$PhysicalNames") return readNames(in_, mesh_);
    const bool v4 = format_.major == 4;
    if (v4 && (name == "$Entities" || name == "$Nodes" || name == "$Elements")) return readSection4(name);
    if (name == "$Nodes") return readNodes(in_, format_, mesh_);
    if (name == "$Elements") return readElements2(in_, format_, mesh_);
    skipSection(in_, name);
  }

  void readSection4(const std::string& name) {
    if (format_.binary) in_.line();
    in_.setBinary(format_.binary);
    if (name == "$Entities") return readMsh4Entities(in_, format_, entities_);
    if (name == "$Nodes") return readMsh4Nodes(in_, format_, mesh_);
    readMsh4Elements(in_, format_, entities_, mesh_);
  }

  ByteReader in_;
  MshFormat format_;
  MshEntities entities_;
  RawMesh mesh_;
};

}  // namespace

RawMesh readMsh(ByteReader in) {
  return MshFile(std::move(in)).read();
}

}  // namespace palpate::mesh
