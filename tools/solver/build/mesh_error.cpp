// SPDX-License-Identifier: Apache-2.0
#include "tools/solver/build/mesh_error.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <optional>
#include <random>
#include <span>
#include <vector>

#include "core/base/index.h"
#include "tools/mesh/quadratic.h"
#include "tools/solver/base/parallel.h"
#include "tools/solver/build/fine_part.h"

namespace palpate::solver {

namespace {

/// On faces of three accessible positions.
std::vector<ContactPoint> draw(const SolverSetup& setup, int count) {
  std::vector<bool> accessible(setup.surface.nodes.size(), false);
  for (std::size_t p = 0; p < setup.positions.nodes.size(); ++p)
    accessible[index(setup.positions.nodes[p])] = setup.positions.accessible[p] != 0;
  std::vector<double> areas;
  for (std::size_t f = 0; f < setup.surface.faces.size(); ++f) {
    const auto& t = setup.surface.faces[f];
    const bool all =
        std::all_of(t.begin(), t.end(), [&](std::int32_t node) { return accessible[index(node)]; });
    const auto [a, b, c] = cornersOf(setup.surface, f);
    areas.push_back(all ? (b - a).cross(c - a).norm() : 0.0);
  }
  std::vector<ContactPoint> samples;
  if (std::all_of(areas.begin(), areas.end(), [](double area) { return area == 0.0; })) return samples;
  std::mt19937 random(1);
  std::discrete_distribution<std::int32_t> face(areas.begin(), areas.end());
  std::uniform_real_distribution<double> uniform;
  for (int i = 0; i < count; ++i) {
    const double root = std::sqrt(uniform(random)), part = uniform(random);
    samples.push_back({face(random), {1.0 - root, root * (1.0 - part), root * part}});
  }
  return samples;
}

/// Whether a spring holds one of the elements; the finer part has none.
bool hasSprings(const FeModel& model, std::span<const std::int32_t> elements) {
  std::vector<bool> sprung(static_cast<std::size_t>(model.nodeCount()), false);
  for (const Spring& spring : model.springs()) sprung[index(spring.node)] = true;
  return std::any_of(elements.begin(), elements.end(), [&](std::int32_t element) {
    const std::span<const std::int32_t> nodes = model.elementNodes(element);
    return std::any_of(nodes.begin(), nodes.end(), [&](std::int32_t node) { return sprung[index(node)]; });
  });
}

/// Linear elements lock everywhere, not only under the tool: the whole organ with quadratic ones.
class RaisedOrgan {
 public:
  RaisedOrgan(const SolverSetup& setup, const mesh::TetMesh& mesh)
      : mesh_(raise(setup, mesh)),
        model_(mesh_.nodes, {mesh_.tetrahedra, mesh_.midsides}, mesh_.groups.at("fixed"),
               setup.model.material(), setup.model.springs()),
        surface_(surfaceOf(model_, mesh_)),
        factor_(model_) {
    factor_.factorize(Eigen::VectorXd::Zero(3 * model_.nodeCount()));
  }
  /// n . K_s n. @param x  X(s); faces are in another order than those of the organ
  [[nodiscard]] double stiffnessAt(const Vec3& x, const Vec3& n, double patch_radius) const {
    const Patch patch = makePatch(model_, surface_, pointAt(surface_, x), patch_radius);
    return stiffnessOf(patch, nodal(model_, factor_.solve(loads(model_, patch))), n);
  }

 private:
  static mesh::TetMesh raise(const SolverSetup& setup, const mesh::TetMesh& mesh) {
    mesh::TetMesh linear = mesh;
    linear.groups = {{"fixed", setup.model.fixedNodes()}};
    return mesh::quadraticOf(linear);
  }

  mesh::TetMesh mesh_;
  FeModel model_;
  PatchSurface surface_;
  Cholesky factor_;
};

}  // namespace

struct MeshErrors::State {
  const SolverSetup& setup;
  const mesh::TetMesh& mesh;
  const Cholesky& factor;
  double reach;
  std::unique_ptr<RaisedOrgan> raised;
};

MeshErrors::MeshErrors(const SolverSetup& setup, const mesh::TetMesh& mesh, const Cholesky& factor)
    : state_(std::make_unique<State>(State{
          setup, mesh, factor, std::max(5.0 * setup.patch_radius, 2.5 * setup.surface.medianEdge()), {}})) {
  constexpr std::size_t kMost = 8000;  // linear nodes: raised, some 60,000, whose factor takes 2 GB
  if (!mesh.isQuadratic() && mesh.nodes.size() <= kMost)
    state_->raised = std::make_unique<RaisedOrgan>(setup, mesh);
}
MeshErrors::~MeshErrors() = default;

bool MeshErrors::raised() const noexcept {
  return state_->raised != nullptr;
}

std::optional<double> MeshErrors::at(const ContactPoint& s) const {
  const SolverSetup& setup = state_->setup;
  const Vec3 x = setup.surface.position(s);
  const auto [a, b, c] = cornersOf(setup.surface, index(s.triangle));
  const Vec3 n = (b - a).cross(c - a).normalized();
  const Patch patch = makePatch(setup.model, setup.surface, s, setup.patch_radius);
  const Columns coarse = nodal(setup.model, state_->factor.solve(loads(setup.model, patch)));
  const double found = stiffnessOf(patch, coarse, n);
  if (state_->raised) return found / state_->raised->stiffnessAt(x, n, setup.patch_radius) - 1.0;
  const std::vector<std::int32_t> chosen = elementsNear(state_->mesh, x, state_->reach);
  if (hasSprings(setup.model, chosen)) return std::nullopt;
  const FinePart fine(setup, state_->mesh, coarse, chosen);
  return found / fine.stiffnessAt(x, n, setup.patch_radius) - 1.0;
}

MeshError meshError(const SolverSetup& setup, const mesh::TetMesh& mesh, const Cholesky& factor,
                    int workers) {
  constexpr int kPoints = 12;
  const MeshErrors errors(setup, mesh, factor);
  const std::vector<ContactPoint> samples = draw(setup, kPoints);
  std::vector<std::optional<double>> found(samples.size());
  parallelFor(workers, samples.size(), [&](int, std::size_t i) { found[i] = errors.at(samples[i]); });
  MeshError error;
  error.raised = errors.raised();
  for (const std::optional<double>& one : found) {
    if (!one) continue;
    error.mean += std::abs(*one);
    error.largest = std::max(error.largest, std::abs(*one));
    ++error.points;
  }
  if (error.points > 0) error.mean /= error.points;
  return error;
}

}  // namespace palpate::solver
