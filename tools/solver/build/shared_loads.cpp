// SPDX-License-Identifier: Apache-2.0
#include "tools/solver/build/shared_loads.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <map>

#include "core/base/contact_point.h"
#include "core/base/index.h"
#include "tools/solver/base/parallel.h"

namespace palpate::solver {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::MatrixXf;

/// By the middle of an edge, its ends.
std::map<std::int32_t, std::array<std::int32_t, 2>> edgesOf(const PatchSurface& surface) {
  std::map<std::int32_t, std::array<std::int32_t, 2>> ends;
  if (surface.faces.size() == surface.triangles.size()) return ends;
  for (std::size_t f = 0; f < surface.faces.size(); ++f)
    for (std::size_t k = 0; k < 3; ++k)
      ends[surface.triangles[4 * f + 3][k]] = {surface.faces[f][(k + 1) % 3], surface.faces[f][(k + 2) % 3]};
  return ends;
}

/// Points of each face with a contact position at all corners: these, the middles of its edges and its own.
std::vector<ContactPoint> samples(const SolverSetup& setup) {
  std::vector<bool> has(setup.surface.nodes.size(), false);
  for (const std::int32_t node : setup.positions.nodes) has[index(node)] = true;
  std::vector<ContactPoint> points;
  for (std::size_t f = 0; f < setup.surface.faces.size(); ++f) {
    const auto& corners = setup.surface.faces[f];
    if (!std::all_of(corners.begin(), corners.end(), [&](std::int32_t node) { return has[index(node)]; }))
      continue;
    const auto t = static_cast<std::int32_t>(f);
    for (std::size_t k = 0; k < 3; ++k) {
      ContactPoint corner{t, {}}, middle{t, {0.5, 0.5, 0.5}};
      corner.barycentric[k] = 1.0;
      middle.barycentric[k] = 0.0;
      points.push_back(corner);
      points.push_back(middle);
    }
    points.push_back({t, {1.0 / 3.0, 1.0 / 3.0, 1.0 / 3.0}});
  }
  return points;
}

}  // namespace

SharedLoads sharedLoads(const SolverSetup& setup, const ContactPatches& patches,
                        std::span<const std::int32_t> loaded) {
  const auto ends = edgesOf(setup.surface);
  std::vector<std::int32_t> row_of(setup.surface.nodes.size(), -1), column_of = row_of;
  SharedLoads loads{{}, {}, 0.0};
  for (std::size_t i = 0; i < loaded.size(); ++i) {
    const auto edge = ends.find(loaded[i]);
    if (edge == ends.end()) return {{}, {}, 0.0};
    row_of[index(loaded[i])] = static_cast<std::int32_t>(i);
    for (const std::int32_t end : edge->second) column_of[index(end)] = 0;
  }
  for (std::size_t node = 0; node < column_of.size(); ++node) {
    if (column_of[node] < 0) continue;
    column_of[node] = static_cast<std::int32_t>(loads.nodes.size());
    loads.nodes.push_back(static_cast<std::int32_t>(node));
  }
  const std::vector<ContactPoint> points = samples(setup);
  const auto G = static_cast<Index>(loaded.size()), S = static_cast<Index>(loads.nodes.size());
  MatrixXd QQ = MatrixXd::Zero(S, S), Qw = MatrixXd::Zero(S, G);
  MatrixXf w = MatrixXf::Zero(G, static_cast<Index>(points.size()));
  MatrixXf q = MatrixXf::Zero(S, w.cols());
  PatchNodes patch = patches.room();
  std::vector<Index> touched;
  for (Index p = 0; p < w.cols(); ++p) {
    patches.at(points[static_cast<std::size_t>(p)], false, patch);
    touched.clear();
    for (std::size_t i = 0; i < patch.count; ++i) {
      w(row_of[index(patch.node[i])], p) = static_cast<float>(patch.weight[i]);
      for (const std::int32_t end : ends.at(patch.node[i])) {
        const Index c = column_of[index(end)];
        if (!(q(c, p) > 0.0F)) touched.push_back(c);
        q(c, p) += static_cast<float>(0.5 * patch.weight[i]);
      }
    }
    for (const Index c : touched) {
      const double here{q(c, p)};
      for (const Index other : touched) QQ(c, other) += here * double{q(other, p)};
      for (std::size_t i = 0; i < patch.count; ++i)
        Qw(c, row_of[index(patch.node[i])]) += here * patch.weight[i];
    }
  }
  constexpr double kRidge = 1e-4;  // of each source's own: what no patch tells apart stays small
  QQ.diagonal() *= 1.0 + kRidge;
  for (Index c = 0; c < S; ++c)
    if (!(QQ(c, c) > 0.0)) QQ(c, c) = 1.0;  // a source of loads in incomplete faces alone
  loads.R = QQ.llt().solve(Qw).transpose().cast<float>();
  loads.error = 0.5 * double{(w - loads.R * q).cwiseAbs().colwise().sum().maxCoeff()};
  return loads;
}

void superpose(const FieldTable& greens, const SharedLoads& loads, int workers, FieldTable& fields) {
  constexpr std::size_t kChunk = 64, kBands = 16;
  const auto rows = static_cast<Index>(greens.rows());
  const std::size_t sources = loads.nodes.size(), count = greens.positions();
  std::vector<float> all(sources * 3 * greens.rows(), 0.0F);
  std::vector<float> chunk(kChunk * 3 * greens.rows());
  for (std::size_t first = 0; first < count; first += kChunk) {
    const std::size_t size = std::min(kChunk, count - first);
    for (std::size_t i = 0; i < size; ++i)
      greens.read(first + i, std::span(chunk).subspan(i * 3 * greens.rows(), 3 * greens.rows()));
    const Eigen::Map<const MatrixXf> W(chunk.data(), 3 * rows, static_cast<Index>(size));
    const MatrixXf R = loads.R.middleRows(static_cast<Index>(first), static_cast<Index>(size));
    Eigen::Map<MatrixXf> V(all.data(), 3 * rows, static_cast<Index>(sources));
    parallelFor(workers, kBands, [&](int, std::size_t part) {
      const auto boundary = [&](std::size_t p) { return 3 * rows * static_cast<Index>(p) / Index{kBands}; };
      const Index begin = boundary(part), end = boundary(part + 1);
      V.middleRows(begin, end - begin).noalias() += W.middleRows(begin, end - begin) * R;
    });
  }
  for (std::size_t c = 0; c < sources; ++c)
    fields.write(c, std::span<const float>(all).subspan(c * 3 * greens.rows(), 3 * greens.rows()));
}

}  // namespace palpate::solver
