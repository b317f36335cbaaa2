// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <vector>

#include "box_model.h"
#include "tools/solver/base/lanes.h"
#include "tools/solver/series/series.h"

namespace palpate::query::test {

/// A model of the box that is driven by force (order 3) or by the level of a load of 0.4 N: the series of
/// every position, with the unit vectors of the surface's degrees of freedom as modes.
class LoadModel {
 public:
  static constexpr int kOrder = 3;
  static constexpr double kLoad = 0.4;
  static Vec3 direction() { return {0.6, 0.0, -0.8}; }

  /// @param patch_radius  m; tiny for nodal loads
  explicit LoadModel(Parameters parameters, double patch_radius = 0.012) {
    writeBoxModel(path);
    const MetaModel box = MetaModel::load(path);
    data_ = dataOf(box, parameters, patch_radius);
    fill(organOf(box, modelfile::readVolumeMesh(path)));
    modelfile::writeModel(path, data_);
  }

  TemporaryFolder folder;
  std::filesystem::path path{folder / "load.h5"};

 private:
  template <typename T>
  static std::vector<T> copy(std::span<const T> values) {
    return {values.begin(), values.end()};
  }

  static modelfile::ModelData dataOf(const MetaModel& box, Parameters parameters, double patch_radius) {
    const ModelView& v = box.view();
    modelfile::ModelData data;
    data.attributes = box.attributes();
    data.attributes.parameters = parameters;
    data.attributes.order = data.attributes.force_order = kOrder;
    data.attributes.patch_radius = patch_radius;
    data.attributes.near_radius = 0.0;
    data.attributes.reference_force = data.attributes.load = kLoad;
    data.attributes.load_direction = {direction().x(), direction().y(), direction().z()};
    data.surface_positions = copy(v.surface_positions);
    data.surface_triangles = copy(v.surface_triangles);
    data.surface_mesh_tag = copy(v.surface_mesh_tag);
    data.position_of_node = copy(v.position_of_node);
    data.contact_node = copy(v.contact_node);
    data.contact_accessible = copy(v.contact_accessible);
    data.near_offset.assign(v.positions() + 1, 0);
    data.mesh_nodes = copy(v.mesh_nodes);
    data.mesh_tetrahedra = copy(v.mesh_tetrahedra);
    data.mesh_node_tag = copy(v.mesh_node_tag);
    data.mesh_tetrahedron_tag = copy(v.mesh_tetrahedron_tag);
    data.mesh_fixed = copy(v.mesh_fixed);
    data.mesh_surface_node = copy(v.mesh_surface_node);
    const std::size_t n = data.surface_positions.size();
    data.modes_X.assign(n * n, 0.0F);
    for (std::size_t i = 0; i < n; ++i) data.modes_X[i * n + i] = 1.0F;
    return data;
  }

  void fill(const Organ& organ) {
    solver::Cholesky factor(organ.body);
    factor.factorize(Eigen::VectorXd::Zero(3 * organ.body.nodeCount()));
    solver::SeriesSolver series(organ.body, factor, kOrder, solver::SeriesKind::kForce);
    const bool level = data_.attributes.parameters == Parameters::kLevel;
    std::vector<solver::Patch> patches;
    for (const std::int32_t node : data_.contact_node)
      patches.push_back(solver::makePatch(organ.body, organ.surface, organ.surface.atNode(node),
                                          data_.attributes.patch_radius));
    for (std::size_t first = 0; first < patches.size(); first += solver::kLanes) {
      const std::size_t count = std::min<std::size_t>(solver::kLanes, patches.size() - first);
      series.solve(std::span(patches).subspan(first, count));
      const std::vector<solver::SeriesRadii> f_max = series.domainRadii({});
      for (std::size_t lane = 0; lane < count; ++lane) {
        data_.contact_domain_radius.push_back(level ? std::min(1.0, f_max[lane].series / kLoad)
                                                    : f_max[lane].series);
        for (int degree = 1; degree <= kOrder; ++degree)
          addDegree(organ, series, static_cast<int>(lane), patches[first + lane], degree);
      }
    }
    for (int q = 1; q <= kOrder && level; ++q)
      for (int step = 0; step <= kSteps; ++step) data_.levels_Z.push_back(std::pow(double(step) / kSteps, q));
  }

  /// The coefficients of one degree: each by itself, or summed up for the load's direction.
  void addDegree(const Organ& organ, const solver::SeriesSolver& series, int lane, const solver::Patch& patch,
                 int degree) {
    const bool level = data_.attributes.parameters == Parameters::kLevel;
    const MonomialBasis& basis = series.basis();
    std::vector<double> monomial(static_cast<std::size_t>(basis.size()));
    basis.evaluate(direction(), monomial);
    Eigen::VectorXd sum = Eigen::VectorXd::Zero(3 * organ.body.nodeCount());
    for (int k = basis.begin(degree); k < basis.begin(degree + 1); ++k) {
      if (!level) sum.setZero();
      const double weight = std::pow(kLoad, degree) * (level ? monomial[static_cast<std::size_t>(k)] : 1.0);
      for (int node = 0; node < organ.body.nodeCount(); ++node)
        sum.segment<3>(3 * node) += weight * series.displacement(lane, k, node);
      if (!level) add(organ, patch, sum);
    }
    if (level) add(organ, patch, sum);
  }

  void add(const Organ& organ, const solver::Patch& patch, const Eigen::VectorXd& u) {
    const Vec3 d = patch.average(u);
    data_.contact_displacement.insert(data_.contact_displacement.end(), {d.x(), d.y(), d.z()});
    for (const std::int32_t node : organ.surface.nodes)
      for (int axis = 0; axis < 3; ++axis) data_.modes_Y.push_back(static_cast<float>(u[3 * node + axis]));
  }

  static constexpr int kSteps = 200;
  modelfile::ModelData data_;
};

}  // namespace palpate::query::test
