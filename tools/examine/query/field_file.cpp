// SPDX-License-Identifier: Apache-2.0
#include "tools/examine/query/field_file.h"

#include <algorithm>
#include <functional>
#include <vector>

#include "core/data/model_view.h"
#include "tools/program/vtu.h"

namespace palpate::query {

namespace {

std::vector<double> nodal(const FullSolution& truth, const Organ& organ, std::size_t nodes) {
  std::vector<double> u;
  for (std::size_t i = 0; i < nodes; ++i) {
    const Vec3 at_node = truth.displacement(organ, static_cast<int>(i));
    u.insert(u.end(), at_node.begin(), at_node.end());
  }
  return u;
}

}  // namespace

std::string fieldVtu(const MetaModel& model, const Answer& answer, const Organ* organ,
                     const FullSolution* truth) {
  const ModelView& view = model.view();
  const std::vector<double> u(answer.field.begin(), answer.field.end());
  program::PointSurface file{.points = {view.surface_positions.begin(), view.surface_positions.end()},
                             .triangles = {view.surface_triangles.begin(), view.surface_triangles.end()},
                             .data = {{"displacement", u}}};
  if (truth != nullptr) {
    const std::vector<double> newton = nodal(*truth, *organ, view.surfaceNodes());
    std::vector<double> error(u.size());
    std::transform(u.begin(), u.end(), newton.begin(), error.begin(), std::minus<>());
    file.data.push_back({"newton", newton});
    file.data.push_back({"error", error});
  }
  file.data.push_back(
      {"mesh_tag", std::vector<std::int64_t>(view.surface_mesh_tag.begin(), view.surface_mesh_tag.end())});
  return program::vtuText(file);
}

}  // namespace palpate::query
