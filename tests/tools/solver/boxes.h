// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>

#include "tools/solver/fem/fe_model.h"
#include "tools/solver/fem/patch.h"

namespace palpate::solver {

/// A box of nx x ny x nz cells, six tetrahedra each along the diagonal from the smallest to the largest
/// corner.
struct Box {
  int nx, ny, nz;
  Vec3 size;  ///< m

  [[nodiscard]] int node(int i, int j, int k) const { return (i * (ny + 1) + j) * (nz + 1) + k; }
  [[nodiscard]] int nodeCount() const { return (nx + 1) * (ny + 1) * (nz + 1); }

  [[nodiscard]] std::vector<Vec3> nodes() const {
    std::vector<Vec3> list;
    for (int i = 0; i <= nx; ++i)
      for (int j = 0; j <= ny; ++j)
        for (int k = 0; k <= nz; ++k)
          list.emplace_back(size.x() * i / nx, size.y() * j / ny, size.z() * k / nz);
    return list;
  }

  [[nodiscard]] std::vector<std::array<std::int32_t, 4>> tetrahedra() const {
    constexpr int kPaths[6][3] = {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}};
    std::vector<std::array<std::int32_t, 4>> list;
    for (int i = 0; i < nx; ++i)
      for (int j = 0; j < ny; ++j)
        for (int k = 0; k < nz; ++k)
          for (int p = 0; p < 6; ++p) {
            int at[3] = {i, j, k};
            std::array<std::int32_t, 4> t{};
            t[0] = node(i, j, k);
            for (std::size_t step = 0; step < 3; ++step) {
              ++at[kPaths[p][step]];
              t[step + 1] = node(at[0], at[1], at[2]);
            }
            if (p >= 3) std::swap(t[2], t[3]);  // odd permutations turn the other way
            list.push_back(t);
          }
    return list;
  }

  [[nodiscard]] std::vector<std::int32_t> face(int axis, bool far) const {
    std::vector<std::int32_t> list;
    for (int i = 0; i <= nx; ++i)
      for (int j = 0; j <= ny; ++j)
        for (int k = 0; k <= nz; ++k) {
          const int at[3] = {i, j, k}, end[3] = {nx, ny, nz};
          if (at[axis] == (far ? end[axis] : 0)) list.push_back(node(i, j, k));
        }
    return list;
  }

  /// Clamped at x = 0.
  [[nodiscard]] FeModel clamped(const Material& material) const {
    return FeModel(nodes(), {tetrahedra()}, face(0, false), material);
  }

  [[nodiscard]] PatchSurface surface(const FeModel& model) const {
    std::map<std::array<std::int32_t, 3>, std::array<std::int32_t, 3>> faces;
    constexpr std::size_t kFaces[4][3] = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}};
    for (const auto& t : model.tetrahedra().corners)
      for (const auto& f : kFaces) {
        const std::array<std::int32_t, 3> face_nodes{t[f[0]], t[f[1]], t[f[2]]};
        std::array<std::int32_t, 3> key = face_nodes;
        std::sort(key.begin(), key.end());
        if (faces.erase(key) == 0) faces[key] = face_nodes;
      }
    std::map<std::int32_t, std::int32_t> index;
    for (const auto& [key, f] : faces)
      for (const std::int32_t n : f) index[n] = 0;
    std::vector<std::int32_t> surface_nodes;
    for (auto& [n, i] : index) {
      i = static_cast<std::int32_t>(surface_nodes.size());
      surface_nodes.push_back(n);
    }
    std::vector<std::array<std::int32_t, 3>> triangles;
    for (const auto& [key, f] : faces) triangles.push_back({index[f[0]], index[f[1]], index[f[2]]});
    return PatchSurface(model, surface_nodes, triangles);
  }
};

}  // namespace palpate::solver
