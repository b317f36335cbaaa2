// SPDX-License-Identifier: Apache-2.0
#include "tools/mesh/eighths.h"

#include <algorithm>
#include <array>
#include <map>
#include <utility>

#include "tools/mesh/topology.h"

namespace palpate::mesh {

namespace {

/// A diagonal of the octahedron between the middles of kTetEdges, and the four others in a ring round it.
struct Diagonal {
  std::array<std::size_t, 2> ends;
  std::array<std::size_t, 4> ring;
};
constexpr std::array<Diagonal, 3> kDiagonals{
    {{{0, 5}, {2, 3, 4, 1}}, {{2, 4}, {0, 3, 5, 1}}, {{3, 1}, {0, 2, 5, 4}}}};

/// Numbers the nodes of the part.
class Part {
 public:
  explicit Part(const TetMesh& whole) : whole_(whole) {}

  void divide(std::int32_t tetrahedron) {
    const std::array<std::int32_t, 4>& t = whole_.tetrahedra[static_cast<std::size_t>(tetrahedron)];
    std::array<std::int32_t, 6> m{};
    for (std::size_t e = 0; e < 6; ++e)
      m[e] =
          middle(t[static_cast<std::size_t>(kTetEdges[e][0])], t[static_cast<std::size_t>(kTetEdges[e][1])]);
    const std::size_t first = out_.mesh.tetrahedra.size();
    add({node(t[0], t[0]), m[0], m[2], m[3]});
    add({m[0], node(t[1], t[1]), m[1], m[4]});
    add({m[2], m[1], node(t[2], t[2]), m[5]});
    add({m[3], m[4], m[5], node(t[3], t[3])});
    const auto length = [&](const Diagonal& d) { return (at(m[d.ends[1]]) - at(m[d.ends[0]])).norm(); };
    const Diagonal& d =
        *std::min_element(kDiagonals.begin(), kDiagonals.end(),
                          [&](const auto& l, const auto& r) { return length(l) < length(r); });
    for (std::size_t k = 0; k < 4; ++k)
      add({m[d.ends[0]], m[d.ends[1]], m[d.ring[k]], m[d.ring[(k + 1) % 4]]});
    out_.parent.resize(out_.parent.size() + out_.mesh.tetrahedra.size() - first, tetrahedron);
  }
  Eighths finish() { return std::move(out_); }

 private:
  [[nodiscard]] const Eigen::Vector3d& at(std::int32_t i) const {
    return out_.mesh.nodes[static_cast<std::size_t>(i)];
  }
  std::int32_t middle(std::int32_t a, std::int32_t b) { return node(std::min(a, b), std::max(a, b)); }
  /// The node in the middle of two, or, where they are one, that.
  std::int32_t node(std::int32_t a, std::int32_t b) {
    const auto [found, is_new] =
        nodes_.try_emplace({a, b}, static_cast<std::int32_t>(out_.mesh.nodes.size()));
    if (is_new) {
      out_.mesh.nodes.push_back(
          0.5 * (whole_.nodes[static_cast<std::size_t>(a)] + whole_.nodes[static_cast<std::size_t>(b)]));
      out_.mesh.node_tags.push_back(static_cast<std::int64_t>(out_.mesh.nodes.size()));
    }
    return found->second;
  }
  void add(const std::array<std::int32_t, 4>& t) {
    out_.mesh.tetrahedra.push_back(t);
    out_.mesh.tetrahedron_tags.push_back(static_cast<std::int64_t>(out_.mesh.tetrahedra.size()));
    if (signedVolume(out_.mesh, out_.mesh.tetrahedra.size() - 1) < 0.0)
      std::swap(out_.mesh.tetrahedra.back()[2], out_.mesh.tetrahedra.back()[3]);
  }

  const TetMesh& whole_;
  Eighths out_;
  std::map<std::pair<std::int32_t, std::int32_t>, std::int32_t> nodes_;
};

}  // namespace

Eighths eighthsOf(const TetMesh& mesh, std::span<const std::int32_t> chosen) {
  Part part(mesh);
  for (const std::int32_t t : chosen) part.divide(t);
  return part.finish();
}

}  // namespace palpate::mesh
