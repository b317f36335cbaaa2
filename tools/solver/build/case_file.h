// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "tools/mesh/tet_mesh.h"
#include "tools/modelfile/default_travel.h"
#include "tools/solver/build/case_error.h"
#include "tools/solver/fem/fe_model.h"
#include "tools/solver/series/series_orders.h"

namespace palpate::solver {

/// How the model is computed, and which parameters it has beside s.     docs/design.md, Reproduction, Series
enum class Method : std::uint8_t {
  kSeriesDisplacement,  ///< series in d, three parts: u(X; s, d), f(s, d)
  kSeriesForce,         ///< series in f, modes only: u(X; s, f)
  kPgdLinear,           ///< linear PGD: u(X; s, t), or u(X; s, f) for any direction
  kPgdExplicit,         ///< load stepping with the ten terms of Eq. (19): u(X; s, t)
  kPgdEuler,            ///< the same without the residual (Remark 2)
};

/// "series-displacement", "series-force", "pgd-linear", "pgd-explicit", "pgd-euler".
[[nodiscard]] std::string toString(Method method);
/// @throw CaseError that lists the methods
[[nodiscard]] Method methodOf(const std::string& name);

/// The load of the PGD methods.
struct LoadCase {
  std::optional<Vec3> direction;    ///< unit vector; absent: -z
  bool any_direction{false};        ///< one right-hand side for each Cartesian direction
  std::optional<double> magnitude;  ///< N, (0, 1e6]; absent: moves the contact by 2 mm
  std::optional<int> steps;         ///< of the load, 1 to 100000; absent: 30
  std::optional<bool> node;         ///< acts on the node alone; absent: on its patch
  std::optional<int> truncation;    ///< m of Eq. (2), 0 to 100000; absent or 0: none

  [[nodiscard]] Vec3 unitDirection() const { return direction.value_or(Vec3(0.0, 0.0, -1.0)); }
  [[nodiscard]] int stepsOrDefault() const { return steps.value_or(30); }
};

/// How the PGD methods enrich. Absent keys: the defaults of LinearPgdOptions and ExplicitOptions.
struct PgdCase {
  std::optional<bool> hadamard;     ///< component-wise pairs, Eq. (3)
  std::optional<double> tolerance;  ///< of the residual, relative, [0, 1)
  std::optional<int> greedy_pairs;  ///< before recompression, modes to 100000; absent: 1.5 modes
  std::optional<int> sweeps;        ///< alternating directions per pair, 1 to 1000
  std::optional<int> update;        ///< pairs between updates of all Y, 0 to 100000; 0: never
  std::optional<int> block;         ///< pairs iterated at once, 1 to 1000
};

/// A volume group of the mesh with its own material.
struct RegionCase {
  std::string group;
  double E{0.0};                   ///< Pa, (0, 1e12]
  std::optional<double> nu;        ///< [-0.99, 0.4999]; absent: as elsewhere
  std::optional<std::string> law;  ///< absent: as elsewhere
  std::string place;               ///< file, line and key of the group, for messages
};

/// Springs under the faces of a group of nodes, stress-free at rest.
struct SpringCase {
  std::string group;
  double stiffness{0.0};  ///< N/m^3, (0, 1e15]
  std::string place;      ///< file, line and key of the group, for messages
};

/// Who the model is for.
enum class Target : std::uint8_t {
  kServer,    ///< as exact as it is asked for, whatever its size
  kHandheld,  ///< a phone, a page: a small file, whose field is less exact than its force
};

/// What to solve: the contents of a case file, or the defaults for a bare mesh. SI units. Absent keys have
/// defaults that depend on the method.
struct Case {
  std::filesystem::path mesh;        ///< volume mesh in metres; relative paths start at the case file
  std::optional<int> element_order;  ///< 1 or 2; absent: see raised()
  bool mesh_error{false};            ///< whether to say how stiff the mesh makes the organ, see meshError()
  std::string fixed{"fixed"};  ///< physical group of the clamped nodes; where springs hold it none is needed
  std::optional<std::string> accessible;  ///< physical group that a tool may touch; absent: all free nodes
  std::string law{"stvk"};                ///< lawOf() knows it
  double E{160e3};                        ///< Pa, (0, 1e12]
  double nu{0.48};                        ///< [-0.99, 0.4999]
  std::vector<RegionCase> regions;        ///< where the material differs
  std::vector<SpringCase> springs;
  Method method{Method::kSeriesDisplacement};
  std::optional<double> patch_radius;  ///< a, m, (0, 1]; absent: 1.3 median surface edges, or 0.8
  std::optional<int> order;            ///< p, 1 to 7; absent: by travel, of other methods 3
  std::optional<int> force_order;      ///< p, at least 2, to 2p, at most 8; absent: by travel, or 2p up to 6
  std::optional<int> modes;            ///< n, 1 to 2000; absent: by field_error beside a near field, else 167
  std::optional<double> near_radius;   ///< rho, m, [0, 1]; absent: 4.5 a, or more where field_error wants it
  Target target{Target::kServer};
  std::optional<double> travel;       ///< m, (0, 0.05]: how far a tool presses; chooses the orders
  std::optional<double> force_error;  ///< of the force within the travel, relative, (0, 1); absent: 0.01
  std::optional<double> field_error;  ///< largest error of the field over abs(d), (0, 1); absent: 0.01
  std::optional<double> size_limit;   ///< of the file, bytes, [1e5, 1e12]; handheld only; absent: 8 or 20 MB
  std::optional<int> sweeps;  ///< of the fit of the modes, 1 to 1000; absent: 3 beside a near field, else 6
  LoadCase load;
  PgdCase pgd;
  std::string text;  ///< the case file as read, for the provenance

  [[nodiscard]] SeriesOrders orders() const {
    const SeriesOrders usual = SeriesOrders::of(order.value_or(3));
    return {usual.fields, force_order.value_or(usual.answer)};
  }
  /// Of the load-driven methods.
  [[nodiscard]] int modesOrDefault() const { return modes.value_or(167); }
  [[nodiscard]] bool handheld() const { return target == Target::kHandheld; }
  [[nodiscard]] double nearRadiusOrDefault(double a) const { return near_radius.value_or(4.5 * a); }
  /// Whether the travel chooses the orders.
  [[nodiscard]] bool ordersByTravel() const {
    return method == Method::kSeriesDisplacement && !order && !force_order;
  }
  /// How far a tool presses, m; of a handheld model without one 4 mm up to order 3, else 7 mm.
  [[nodiscard]] double travelOrDefault() const {
    return travel.value_or(!handheld()              ? modelfile::defaultTravel(E)
                           : order.value_or(3) <= 3 ? kHandheldTravel
                                                    : kHandheldLongTravel);
  }
  [[nodiscard]] double sizeLimitOrDefault() const {
    return size_limit.value_or(order.value_or(3) <= 3 && travelOrDefault() <= kHandheldTravel ? 8e6 : 20e6);
  }
  static constexpr double kHandheldTravel = 0.004, kHandheldLongTravel = 0.007;
  [[nodiscard]] double forceErrorOrDefault() const { return force_error.value_or(0.01); }
  [[nodiscard]] double fieldErrorOrDefault() const { return field_error.value_or(0.01); }
  [[nodiscard]] int sweepsOrDefault() const {
    return sweeps.value_or(method == Method::kSeriesDisplacement ? 3 : 6);
  }
  [[nodiscard]] bool nodalLoad() const { return load.node.value_or(false); }
};

/// Refuses keys that contradict each other, and keys that the method does not use.
/// @throw CaseError naming the key, the method and the reason
void checkCase(const Case& c);

/// Reads a case file (TOML). Refuses, by name and line, keys that are unknown, of a wrong type or out of
/// range. checkCase() judges whether the keys fit the method, after the command line has changed the case.
/// @throw CaseError
[[nodiscard]] Case readCase(const std::filesystem::path& path);
/// The same of a text. @param[in] path  of its file, for messages and relative paths
[[nodiscard]] Case parseCase(const std::filesystem::path& path, std::string text);

/// The mesh with the elements that the case asks for. Where it does not say: quadratic ones for a series in d and nu > 0.3,
/// since linear ones lock (docs/design.md, Elements); the methods of the paper keep its linear ones; a quadratic mesh stays.
/// @throw CaseError where linear elements are asked of a quadratic mesh
[[nodiscard]] mesh::TetMesh raised(const Case& c, mesh::TetMesh mesh);

/// The defaults for a mesh without a case file. A group `accessible` of the mesh is used; see tools/make/solve.
[[nodiscard]] Case defaultCase(const std::filesystem::path& mesh);

}  // namespace palpate::solver
