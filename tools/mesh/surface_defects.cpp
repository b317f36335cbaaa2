// SPDX-License-Identifier: Apache-2.0
#include "tools/mesh/surface_defects.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <map>
#include <numeric>

#include "tools/mesh/manifold.h"
#include "tools/program/printed.h"

namespace palpate::mesh {
namespace {

using Vec3 = Eigen::Vector3d;

constexpr double kDegenerate = 1e-10;  // area over longest edge squared; 0.433 for a regular triangle
constexpr std::size_t kExamples = 3;

// An edge, and the triangles that pass it from its lower to its higher vertex, and back.
struct EdgeTriangles {
  std::vector<std::size_t> forward, backward;
};
using Edges = std::map<std::pair<std::int32_t, std::int32_t>, EdgeTriangles>;

class Finder {
 public:
  explicit Finder(const TriangleSurface& surface)
      : surface_(surface), is_left_out_(surface.triangles.size()) {}

  std::vector<SurfaceDefect> find() {
    findTriangles();
    findTwins();
    const Edges edges = edgesOf();
    findHoles(edges);
    findEdges(edges);
    findFans();
    findCrossings();
    return std::move(found_);
  }

 private:
  const Vec3& at(std::int32_t v) const { return surface_.vertices[static_cast<std::size_t>(v)]; }
  Vec3 centre(std::size_t t) const {
    const auto& c = surface_.triangles[t];
    return (at(c[0]) + at(c[1]) + at(c[2])) / 3;
  }

  /// @param what  behind the count, of one and of several
  void add(const std::vector<SurfaceDefect::Example>& all, const char* one, const char* several) {
    if (all.empty()) return;
    SurfaceDefect defect{
        all.size(), std::to_string(all.size()) + ' ' + (all.size() == 1 ? one : several), {}};
    for (std::size_t i = 0; i < std::min(all.size(), kExamples); ++i) defect.examples.push_back(all[i]);
    found_.push_back(std::move(defect));
  }

  SurfaceDefect::Example example(const Vec3& place, const std::vector<std::size_t>& triangles) const {
    SurfaceDefect::Example e{place, {}};
    for (const std::size_t t : triangles) e.triangles.push_back(surface_.triangle_tags[t]);
    return e;
  }

  void findTriangles() {
    std::vector<SurfaceDefect::Example> not_finite, flat;
    for (std::size_t t = 0; t < surface_.triangles.size(); ++t) {
      const auto& c = surface_.triangles[t];
      const Vec3 &a = at(c[0]), &b = at(c[1]), &d = at(c[2]);
      const double longest = std::max({(b - a).norm(), (d - b).norm(), (a - d).norm()});
      const double area = (b - a).cross(d - a).norm() / 2;
      const bool finite = a.allFinite() && b.allFinite() && d.allFinite();
      if (finite && area > kDegenerate * longest * longest) continue;
      is_left_out_[t] = true;
      (finite ? flat : not_finite).push_back(example(centre(t), {t}));
    }
    add(not_finite, "triangle has a coordinate that is not finite",
        "triangles have coordinates that are not finite");
    add(flat, "triangle has no area", "triangles have no area");
  }

  void findTwins() {
    std::map<Triangle, std::size_t> first;
    std::vector<SurfaceDefect::Example> twins;
    for (std::size_t t = 0; t < surface_.triangles.size(); ++t) {
      if (is_left_out_[t]) continue;
      Triangle key = surface_.triangles[t];
      std::sort(key.begin(), key.end());
      const auto [other, is_new] = first.emplace(key, t);
      if (is_new) continue;
      twins.push_back(example(centre(t), {other->second, t}));
      is_left_out_[t] = true;
    }
    add(twins, "triangle is there twice", "triangles are there twice");
  }

  Edges edgesOf() const {
    Edges edges;
    for (std::size_t t = 0; t < surface_.triangles.size(); ++t) {
      if (is_left_out_[t]) continue;
      for (std::size_t i = 0; i < 3; ++i) {
        const auto a = surface_.triangles[t][i], b = surface_.triangles[t][(i + 1) % 3];
        EdgeTriangles& edge = edges[std::minmax(a, b)];
        (a < b ? edge.forward : edge.backward).push_back(t);
      }
    }
    return edges;
  }

  // Edges of one triangle that hang together are the rim of one hole.
  void findHoles(const Edges& edges) {
    std::map<std::int32_t, std::int32_t> parent;
    const auto root = [&](std::int32_t v) {
      while (parent.emplace(v, v).first->second != v) v = parent[v];
      return v;
    };
    for (const auto& [ends, in] : edges)
      if (in.forward.size() + in.backward.size() == 1) parent[root(ends.second)] = root(ends.first);
    struct Rim {
      Vec3 sum = Vec3::Zero();
      int edges = 0;
      std::size_t triangle = 0;
    };
    std::map<std::int32_t, Rim> rims;
    for (const auto& [ends, in] : edges) {
      if (in.forward.size() + in.backward.size() != 1) continue;
      Rim& rim = rims[root(ends.first)];
      rim.sum += (at(ends.first) + at(ends.second)) / 2;
      if (++rim.edges == 1) rim.triangle = in.forward.empty() ? in.backward[0] : in.forward[0];
    }
    std::vector<SurfaceDefect::Example> holes;
    for (const auto& [start, rim] : rims) holes.push_back(example(rim.sum / rim.edges, {rim.triangle}));
    add(holes, "hole: the surface is not closed", "holes: the surface is not closed");
  }

  void findEdges(const Edges& edges) {
    std::vector<SurfaceDefect::Example> crowded, against;
    for (const auto& [ends, in] : edges) {
      std::vector<std::size_t> triangles = in.forward;
      triangles.insert(triangles.end(), in.backward.begin(), in.backward.end());
      const Vec3 middle = (at(ends.first) + at(ends.second)) / 2;
      if (triangles.size() > 2) crowded.push_back(example(middle, triangles));
      if (triangles.size() == 2 && in.forward.size() != 1) against.push_back(example(middle, triangles));
    }
    add(crowded, "edge lies in more than two triangles", "edges lie in more than two triangles");
    add(against, "edge is passed in the same direction by both triangles: one is turned over",
        "edges are passed in the same direction by both triangles: parts are turned over");
  }

  // Triangles without area and twins belong to the fans, which would part without them.
  void findFans() {
    std::vector<SurfaceDefect::Example> joined;
    for (const JoinedFans& fans : joinedFans(surface_.triangles, surface_.vertices.size()))
      joined.push_back(example(at(fans.vertex), {fans.triangles.begin(), fans.triangles.end()}));
    add(joined, "vertex joins several fans of triangles", "vertices join several fans of triangles");
  }

  void findCrossings() {
    std::vector<SurfaceDefect::Example> crossings;
    const auto pairs = selfIntersections(surface_);
    for (const auto& [a, b] : pairs)
      if (!is_left_out_[a] && !is_left_out_[b])
        crossings.push_back(example((centre(a) + centre(b)) / 2, {a, b}));
    add(crossings, "pair of triangles intersects: the surface cuts itself",
        "pairs of triangles intersect: the surface cuts itself");
    if (!crossings.empty() && pairs.size() >= kMostCrossings) found_.back().what.insert(0, "at least ");
  }

  const TriangleSurface& surface_;
  std::vector<bool> is_left_out_;  // triangles with a defect of their own
  std::vector<SurfaceDefect> found_;
};

std::string inWords(const SurfaceDefect::Example& example) {
  std::string words =
      program::printed("(%.4g %.4g %.4g) m", example.place.x(), example.place.y(), example.place.z());
  for (std::size_t i = 0; i < example.triangles.size(); ++i) {
    words += i > 0 ? " and " : example.triangles.size() > 1 ? " (triangles " : " (triangle ";
    words += std::to_string(example.triangles[i]);
  }
  return words + (example.triangles.empty() ? "" : ")");
}

}  // namespace

std::vector<SurfaceDefect> surfaceDefects(const TriangleSurface& surface) {
  return Finder(surface).find();
}

std::string inWords(const std::vector<SurfaceDefect>& defects) {
  std::string words;
  for (const auto& defect : defects) {
    words += (words.empty() ? "" : "; ") + defect.what;
    for (std::size_t i = 0; i < defect.examples.size(); ++i)
      words += (i == 0 ? ", at " : ", ") + inWords(defect.examples[i]);
    if (defect.count > defect.examples.size()) words += ", ...";
  }
  return words;
}

}  // namespace palpate::mesh
