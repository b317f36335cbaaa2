// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "core/model/meta_model.h"
#include "tools/examine/query/answer.h"
#include "tools/modelfile/read_volume_mesh.h"
#include "tools/solver/fem/fe_model.h"
#include "tools/solver/fem/newton.h"
#include "tools/solver/fem/patch.h"

namespace palpate::query {

/// The organ of a model file as the full problem that the model was made from.
struct Organ {
  solver::FeModel body;
  solver::PatchSurface surface;  ///< numbered like the model's own surface
  modelfile::VolumeMesh mesh;
};

/// @param mesh  of the same file as `model`  @throw QueryError when a tetrahedron has no volume
[[nodiscard]] Organ organOf(const MetaModel& model, modelfile::VolumeMesh mesh);

/// The patch centred at s itself. One narrower than the mesh is the point load's own, see solveUnderLoad().
/// @throw QueryError when it is all clamped
[[nodiscard]] solver::Patch patchAt(const Organ& organ, const Anchor& anchor, double patch_radius);

/// The truth about one touch: f_int(u) = G_s f, G_s^T u = d, the patch centred at s itself.  docs/design.md, Series
struct FullSolution {
  solver::Patch patch;         ///< volume nodes and their w_i
  solver::NewtonResult state;  ///< u of all volume nodes, m; f, N
  Vec3 d = Vec3::Zero();       ///< G_s^T u, or the d that was asked for, m
  double min_det_f{1.0};       ///< over all tetrahedra; <= 0 where one is inside out

  /// u at a surface node, m.
  [[nodiscard]] Vec3 displacement(const Organ& organ, int surface_node) const {
    return state.u.segment<3>(3 * organ.surface.nodes[static_cast<std::size_t>(surface_node)]);
  }
};

/// @param d  m, as asked for, not clamped to the model's domain  @param steps  load steps, >= 1
/// @throw QueryError when the patch at s is all clamped, or Newton does not converge. Seconds.
[[nodiscard]] FullSolution solveFully(const Organ& organ, const Anchor& anchor, double patch_radius,
                                      const Vec3& d, int steps);

/// What one tool imposes on the organ.
struct Touch {
  Anchor anchor;
  Vec3 d = Vec3::Zero();  ///< m
};

/// Several tools at once: f_int(u) = sum_A G_A f_A, G_A^T u = d_A. `patch`, `d` and state.force are the first
/// tool's, state.forces those of all. @param steps  load steps, >= 1
/// @throw QueryError like solveFully(). Seconds.
[[nodiscard]] FullSolution solveTogether(const Organ& organ, std::span<const Touch> touches,
                                         double patch_radius, int steps);

/// The organ under a given force: f_int(u) = G_s f, a dead load on the patch centred at s itself.   docs/design.md, Reproduction
/// A patch narrower than the mesh is the point load's own: the node at s, or the triangle's corners by their
/// barycentric weights. @param f  N, not clamped  @param steps  load steps, >= 1
/// @throw QueryError like solveFully(). Seconds.
[[nodiscard]] FullSolution solveUnderLoad(const Organ& organ, const Anchor& anchor, double patch_radius,
                                          const Vec3& f, int steps);

/// How far the model is off.
struct Errors {
  double force{0.0};         ///< |f - f_Newton| / |f_Newton|
  double displacement{0.0};  ///< |d - d_Newton| / |d_Newton|
  double field_max{0.0};     ///< largest |u - u_Newton| over the surface nodes / |d_Newton|
  double field_l2{0.0};      ///< area-weighted L2 of u - u_Newton over the surface / that of u_Newton
};

/// How far a field is off.
struct FieldErrors {
  double max{0.0};  ///< largest |u - u_Newton| over the surface nodes / length
  double l2{0.0};   ///< area-weighted L2 of u - u_Newton over the surface / that of u_Newton
};

/// @param field  [Ns][3] m  @param length  m. 0 where both are at rest.
[[nodiscard]] FieldErrors fieldErrors(std::span<const float> field, const FullSolution& truth,
                                      const Organ& organ, double length);

/// |v - v_Newton| / |v_Newton|, 0 where both are zero.
[[nodiscard]] double relativeError(const Vec3& v, const Vec3& v_newton);

/// d_Newton is what was asked for where a displacement was. All errors are 0 where model and truth are both at
/// rest.
[[nodiscard]] Errors errorsOf(const Answer& answer, const FullSolution& truth, const Organ& organ);

}  // namespace palpate::query
