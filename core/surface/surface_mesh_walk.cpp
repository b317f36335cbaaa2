// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "core/base/index.h"
#include "core/surface/surface_mesh.h"

namespace palpate {

namespace {

/// Two unit vectors normal to n and to each other.
Mat32 tangentsOf(const Vec3& n) noexcept PALPATE_NONBLOCKING {
  Eigen::Index least = 0;
  n.cwiseAbs().minCoeff(&least);
  Mat32 tangent;
  tangent.col(0) = Vec3::Unit(least).cross(n).normalized();
  tangent.col(1) = n.cross(tangent.col(0));
  return tangent;
}

/// The vector in the plane of `face` that looks like v from along n. Where the plane is seen from its edge: v
/// laid into it.
Vec3 intoPlane(const Vec3& v, const Vec3& face, const Vec3& n) noexcept PALPATE_NONBLOCKING {
  constexpr double kSteepest = 0.2;  // cosine: the way may get five times as long
  const double cosine = face.dot(n);
  return cosine > kSteepest ? Vec3(v - n * (face.dot(v) / cosine)) : Vec3(v - face * face.dot(v));
}

/// The part of the way s + t rate, t in [0, 1], that stays in the triangle, and the edge where it leaves.
struct Exit {
  double t{1.0};
  std::size_t edge{3};  ///< 3: it does not leave
};

Exit exitOf(const ContactPoint& s, const Vec3& rate) noexcept PALPATE_NONBLOCKING {
  constexpr double kAlong = 1e-12;  // slower than that it goes along the edge
  Exit exit;
  for (std::size_t k = 0; k < 3; ++k) {
    const double r = rate[static_cast<Eigen::Index>(k)];
    if (!(r < -kAlong) || !(-s.barycentric[k] / r < exit.t)) continue;
    exit = {std::max(0.0, -s.barycentric[k] / r), k};
  }
  return exit;
}

/// Part of v that is normal to the unit vector e, as a unit vector.
Vec3 across(const Vec3& v, const Vec3& e) noexcept PALPATE_NONBLOCKING {
  return (v - e * e.dot(v)).normalized();
}

}  // namespace

std::array<Vec3, 3> SurfaceMesh::corners(std::int32_t triangle) const noexcept PALPATE_NONBLOCKING {
  const std::int32_t* const node = triangles_.data() + 3 * index(triangle);
  return {nodePosition(node[0]), nodePosition(node[1]), nodePosition(node[2])};
}

Mat3 SurfaceMesh::slopes(std::int32_t triangle) const noexcept PALPATE_NONBLOCKING {
  const std::array<Vec3, 3> X = corners(triangle);
  const Vec3 area = (X[1] - X[0]).cross(X[2] - X[0]), over = area / area.squaredNorm();
  Mat3 slopes;
  slopes << over.cross(X[2] - X[1]).transpose(), over.cross(X[0] - X[2]).transpose(),
      over.cross(X[1] - X[0]).transpose();
  return slopes;
}

TangentFrame SurfaceMesh::place(const ContactPoint& s) const noexcept PALPATE_NONBLOCKING {
  TangentFrame frame;
  frame.position = position(s);
  frame.normal = normal(s);
  frame.tangent = tangentsOf(frame.normal);
  for (Eigen::Index i = 0; i < 2; ++i)
    frame.along.col(i) = intoPlane(frame.tangent.col(i), face_normals_[index(s.triangle)], frame.normal);
  return frame;
}

TangentFrame SurfaceMesh::frame(const ContactPoint& s) const noexcept PALPATE_NONBLOCKING {
  TangentFrame frame = place(s);
  const double length = std::max(mixedNormal(s).norm(), kLeastNormal);
  const std::int32_t* const node = triangles_.data() + 3 * index(s.triangle);
  const Mat3 slope = slopes(s.triangle);
  for (Eigen::Index i = 0; i < 2; ++i) {
    const Vec3 rate = slope * frame.along.col(i);
    Vec3 turning = Vec3::Zero();
    for (std::size_t k = 0; k < 3; ++k)
      turning += rate[static_cast<Eigen::Index>(k)] * node_normals_[index(node[k])];
    frame.rates.col(i) = rate;
    frame.turning.col(i) = (turning - frame.normal * frame.normal.dot(turning)) / length;
  }
  return frame;
}

bool SurfaceMesh::reachable(std::int32_t triangle) const noexcept PALPATE_NONBLOCKING {
  return reachable_[index(triangle)] != 0;
}

/// s, on an edge, as a point of the triangle on its other side; w turned over the edge into that one's plane.
void SurfaceMesh::crossEdge(ContactPoint& s, std::size_t edge, std::int32_t to,
                            Vec3& w) const noexcept PALPATE_NONBLOCKING {
  const std::int32_t* const from_node = triangles_.data() + 3 * index(s.triangle);
  const std::int32_t* const to_node = triangles_.data() + 3 * index(to);
  const std::array<Vec3, 3> from = corners(s.triangle), other = corners(to);
  const std::size_t a = (edge + 1) % 3, b = (edge + 2) % 3;
  const Vec3 e = (from[b] - from[a]).normalized();
  ContactPoint there{to, {}};
  Vec3 inward = Vec3::Zero();
  for (std::size_t k = 0; k < 3; ++k) {
    if (to_node[k] == from_node[a])
      there.barycentric[k] = s.barycentric[a];
    else if (to_node[k] == from_node[b])
      there.barycentric[k] = s.barycentric[b];
    else
      inward = across(other[k] - from[a], e);
  }
  const Vec3 outward = -across(from[edge] - from[a], e);
  w = e * e.dot(w) + inward * outward.dot(w);
  s = there;
}

bool SurfaceMesh::move(ContactPoint& s, const Vec3& v, Reach reach) const noexcept PALPATE_NONBLOCKING {
  Vec3 w = intoPlane(v, face_normals_[index(s.triangle)], normal(s));
  for (int crossing = 0; crossing <= kMaxCrossings; ++crossing) {
    const Vec3 rate = slopes(s.triangle) * w;
    const Exit exit = exitOf(s, rate);
    for (std::size_t k = 0; k < 3; ++k)
      s.barycentric[k] = std::max(0.0, s.barycentric[k] + exit.t * rate[static_cast<Eigen::Index>(k)]);
    if (exit.edge == 3) return true;
    s.barycentric[exit.edge] = 0.0;
    const double sum = s.barycentric[0] + s.barycentric[1] + s.barycentric[2];
    for (double& weight : s.barycentric) weight /= sum;
    const std::int32_t to = neighbours_[index(s.triangle)][exit.edge];
    if (reach == Reach::kAccessible && !reachable(to)) return false;
    w *= 1.0 - exit.t;
    crossEdge(s, exit.edge, to, w);
  }
  return true;
}

bool SurfaceMesh::project(const Vec3& c, ContactPoint& s, double& h) const noexcept PALPATE_NONBLOCKING {
  constexpr int kMaxIterations = 12;
  constexpr double kTolerance = 1e-10;    // m
  constexpr double kLeastStretch = 0.05;  // of an offset surface against its rest surface; below, it folds
  ContactPoint at = s;
  for (int i = 0; i < kMaxIterations; ++i) {
    const TangentFrame here = frame(at);
    const Vec3 gap = c - here.position;
    const Vec2 aside = here.tangent.transpose() * gap;
    const double height = here.normal.dot(gap);
    if (aside.norm() <= kTolerance) {
      s = at;
      h = height;
      return true;
    }
    const Mat2 stretch = Mat2::Identity() + height * here.tangent.transpose() * here.turning;
    if (!(stretch.determinant() > kLeastStretch)) return false;
    Vec2 step = stretch.inverse() * aside;
    step *= std::min(1.0, gap.norm() / step.norm());
    (void)move(at, here.tangent * step, Reach::kEverywhere);
  }
  return false;
}

/// The first of the steps v, v / 2, ... from s that comes nearer to c. @return its length; 0: none, s as it was
double SurfaceMesh::stepNearer(const Vec3& c, Vec3 v, ContactPoint& s) const noexcept PALPATE_NONBLOCKING {
  constexpr int kMaxHalvings = 4;
  const double distance = (c - position(s)).squaredNorm();
  for (int halving = 0; halving <= kMaxHalvings; ++halving, v *= 0.5) {
    ContactPoint at = s;
    (void)move(at, v, Reach::kEverywhere);
    if (!((c - position(at)).squaredNorm() < distance)) continue;
    s = at;
    return v.norm();
  }
  return 0.0;
}

void SurfaceMesh::descend(const Vec3& c, double farthest,
                          ContactPoint& s) const noexcept PALPATE_NONBLOCKING {
  constexpr int kMaxSteps = 8;
  constexpr double kShortest = 1e-6;  // m
  for (int i = 0; i < kMaxSteps; ++i) {
    const Vec3 n = normal(s), gap = c - position(s);
    Vec3 aside = gap - n * n.dot(gap);
    const double length = std::min(aside.norm(), farthest);
    if (!(length > kShortest)) return;
    aside *= length / aside.norm();
    const double went = stepNearer(c, aside, s);
    if (went == 0.0) return;
    farthest -= went;
  }
}

}  // namespace palpate
