// SPDX-License-Identifier: Apache-2.0
#include "tools/solver/build/shared_loads.h"

#include <Eigen/Cholesky>
#include <Eigen/SparseCore>
#include <algorithm>
#include <array>
#include <map>

#include "core/base/contact_point.h"
#include "core/base/index.h"
#include "tools/solver/base/parallel.h"
#include "tools/solver/base/progress.h"

namespace palpate::solver {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::MatrixXf;
using Columns = Eigen::SparseMatrix<float>;

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

/// By loaded node and by source, where they stand among each other; -1: nowhere.
struct Places {
  std::vector<std::int32_t> loaded, source;
};

/// What the patches of all samples load, and what the ends of these edges are the sources of.
struct Samples {
  Columns w;  ///< [loaded nodes][samples]
  Columns q;  ///< [sources][samples]
};

Samples sampled(const ContactPatches& patches,
                const std::map<std::int32_t, std::array<std::int32_t, 2>>& ends, const Places& at,
                std::span<const ContactPoint> points, Index loaded, Index sources) {
  const auto count = static_cast<Index>(points.size());
  Samples samples{Columns(loaded, count), Columns(sources, count)};
  PatchNodes patch = patches.room();
  std::map<Index, float> shares;
  for (Index p = 0; p < count; ++p) {
    patches.at(points[static_cast<std::size_t>(p)], false, patch);
    shares.clear();
    samples.w.startVec(p);
    for (std::size_t i = 0; i < patch.count; ++i) {
      samples.w.insertBack(at.loaded[index(patch.node[i])], p) = static_cast<float>(patch.weight[i]);
      for (const std::int32_t end : ends.at(patch.node[i]))
        shares[at.source[index(end)]] += static_cast<float>(0.5 * patch.weight[i]);
    }
    samples.q.startVec(p);
    for (const auto& [source, share] : shares) samples.q.insertBack(source, p) = share;
  }
  samples.w.finalize();
  samples.q.finalize();
  return samples;
}

/// Gram matrix of the rows of q, with a ridge.
MatrixXd gramOf(const Columns& q) {
  constexpr double kRidge = 1e-4;  // of each source's own: what no patch tells apart stays small
  MatrixXd QQ = MatrixXd::Zero(q.rows(), q.rows());
  for (Index p = 0; p < q.cols(); ++p)
    for (Columns::InnerIterator here(q, p); here; ++here)
      for (Columns::InnerIterator other(q, p); other; ++other)
        QQ(other.row(), here.row()) += double{here.value()} * double{other.value()};
  QQ.diagonal() *= 1.0 + kRidge;
  for (Index c = 0; c < QQ.rows(); ++c)
    if (!(QQ(c, c) > 0.0)) QQ(c, c) = 1.0;  // a source of loads in incomplete faces alone
  return QQ;
}

/// The loads by least squares.
MatrixXf solved(const Samples& samples, int workers, bool quiet) {
  constexpr Index kBlock = 128;  // loaded nodes at once
  MatrixXd QQ = gramOf(samples.q);
  const Eigen::LLT<Eigen::Ref<MatrixXd>> factor(QQ);
  const Eigen::SparseMatrix<double> Qw = samples.q.cast<double>() * samples.w.cast<double>().transpose();
  MatrixXf R(samples.w.rows(), samples.q.rows());
  const std::size_t blocks = static_cast<std::size_t>((R.rows() + kBlock - 1) / kBlock);
  Progress progress("shared loads", blocks, quiet);
  parallelFor(workers, blocks, [&](int, std::size_t block) {
    const Index first = kBlock * static_cast<Index>(block), size = std::min(kBlock, R.rows() - first);
    R.middleRows(first, size) = factor.solve(MatrixXd(Qw.middleCols(first, size))).transpose().cast<float>();
    progress.advance();
  });
  return R;
}

/// The largest part of a sample's load that R places elsewhere.
double errorOf(const Samples& samples, const MatrixXf& R, int workers) {
  constexpr Index kBlock = 256;
  std::vector<double> largest(static_cast<std::size_t>((samples.w.cols() + kBlock - 1) / kBlock), 0.0);
  parallelFor(workers, largest.size(), [&](int, std::size_t block) {
    Eigen::VectorXf missed(samples.w.rows());
    const Index first = kBlock * static_cast<Index>(block);
    for (Index p = first; p < std::min(first + kBlock, samples.w.cols()); ++p) {
      missed = samples.w.col(p);
      for (Columns::InnerIterator source(samples.q, p); source; ++source)
        missed -= source.value() * R.col(source.row());
      largest[block] = std::max(largest[block], 0.5 * double{missed.cwiseAbs().sum()});
    }
  });
  return largest.empty() ? 0.0 : *std::max_element(largest.begin(), largest.end());
}

}  // namespace

std::vector<std::int32_t> sharedSources(const PatchSurface& surface, std::span<const std::int32_t> loaded) {
  const auto ends = edgesOf(surface);
  std::vector<std::int32_t> nodes;
  for (const std::int32_t node : loaded) {
    const auto edge = ends.find(node);
    if (edge == ends.end()) return {};
    nodes.insert(nodes.end(), edge->second.begin(), edge->second.end());
  }
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  return nodes;
}

SharedLoads sharedLoads(const SolverSetup& setup, const ContactPatches& patches,
                        std::span<const std::int32_t> loaded, int workers, bool quiet) {
  SharedLoads loads{sharedSources(setup.surface, loaded), {}, 0.0};
  if (loads.nodes.empty()) return loads;
  Places at{std::vector<std::int32_t>(setup.surface.nodes.size(), -1), {}};
  at.source = at.loaded;
  for (std::size_t i = 0; i < loaded.size(); ++i) at.loaded[index(loaded[i])] = static_cast<std::int32_t>(i);
  for (std::size_t c = 0; c < loads.nodes.size(); ++c)
    at.source[index(loads.nodes[c])] = static_cast<std::int32_t>(c);
  const Samples all = sampled(patches, edgesOf(setup.surface), at, samples(setup),
                              static_cast<Index>(loaded.size()), static_cast<Index>(loads.nodes.size()));
  loads.R = solved(all, workers, quiet);
  loads.error = errorOf(all, loads.R, workers);
  return loads;
}

void superpose(const FieldTable& greens, const SharedLoads& loads, const BuildOptions& options,
               FieldTable& fields, std::size_t bytes) {
  constexpr std::size_t kChunk = 64, kBands = 16;
  const std::size_t count = loads.nodes.size(), length = 3 * greens.rows(),
                    most = std::max(kChunk, bytes / (sizeof(float) * length));
  const auto rows = static_cast<Index>(length);
  std::vector<float> chunk(kChunk * length);
  Progress progress("fields of shared loads", greens.positions() * ((count + most - 1) / most),
                    options.quiet);
  for (std::size_t begin = 0; begin < count; begin += most) {
    const Index sources = static_cast<Index>(std::min(most, count - begin));
    MatrixXf V = MatrixXf::Zero(rows, sources);
    for (std::size_t first = 0; first < greens.positions(); first += kChunk) {
      const std::size_t size = std::min(kChunk, greens.positions() - first);
      for (std::size_t i = 0; i < size; ++i)
        greens.read(first + i, std::span(chunk).subspan(i * length, length));
      const Eigen::Map<const MatrixXf> W(chunk.data(), rows, static_cast<Index>(size));
      const MatrixXf R =
          loads.R.block(static_cast<Index>(first), static_cast<Index>(begin), W.cols(), sources);
      parallelFor(options.workers, kBands, [&](int, std::size_t part) {
        const auto boundary = [&](std::size_t p) { return rows * static_cast<Index>(p) / Index{kBands}; };
        const Index top = boundary(part), bottom = boundary(part + 1);
        V.middleRows(top, bottom - top).noalias() += W.middleRows(top, bottom - top) * R;
      });
      progress.advance(size);
    }
    for (Index c = 0; c < sources; ++c)
      fields.write(begin + static_cast<std::size_t>(c), std::span<const float>(V.col(c).data(), length));
  }
}

}  // namespace palpate::solver
