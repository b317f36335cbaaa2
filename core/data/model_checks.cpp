// SPDX-License-Identifier: Apache-2.0
#include "core/data/model_checks.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/index.h"
#include "core/base/multi_index.h"
#include "core/base/types.h"
#include "core/data/checker.h"
#include "core/data/datasets.h"
#include "core/data/face_checks.h"
#include "core/data/load_driven_checks.h"

namespace palpate {

namespace {

// What loops is not inlined, for the reason that Checker names.

void checkOrders(const ModelAttributes& a, const Checker& check) {
  const int highest = a.parameters == Parameters::kForce ? a.order : kMostForceOrder;
  check.require(a.order >= 1 && a.order <= kMostOrder, "attribute order is " + std::to_string(a.order),
                "1 to " + std::to_string(kMostOrder));
  check.require(a.force_order >= a.order && a.force_order <= highest,
                "attribute force_order is " + std::to_string(a.force_order),
                a.order == highest ? std::to_string(highest)
                                   : std::to_string(a.order) + " to " + std::to_string(highest));
}

/// The largest |d|, |f| or t that is trusted.
[[gnu::noinline]] void checkDomain(Parameters parameters, std::span<const double> radius,
                                   const Checker& check) {
  for (std::size_t m = 0; m < radius.size(); ++m) {
    const auto fail = [&](const char* expected) {
      check.failAt(dataset::kContactDomainRadius.name(), m, "is " + digitsOf(radius[m]), expected);
    };
    if (parameters == Parameters::kDisplacement && radius[m] < 0.0) fail("at least 0");
    if (parameters == Parameters::kForce && !(radius[m] > 0.0)) fail("more than 0 N");
    if (parameters == Parameters::kLevel && !(radius[m] > 0.0 && radius[m] <= 1.0))
      fail("more than 0, at most 1");
  }
}

/// The polynomials go at least as far as they are to be trusted.
[[gnu::noinline]] void checkSeries(std::span<const double> series, std::span<const double> domain,
                                   const Checker& check) {
  for (std::size_t m = 0; m < series.size(); ++m) {
    if (!(series[m] > 0.0))
      check.failAt(dataset::kContactSeriesRadius.name(), m, "is " + digitsOf(series[m]), "more than 0 m");
    if (!(series[m] >= domain[m]))
      check.failAt(dataset::kContactSeriesRadius.name(), m, "is " + digitsOf(series[m]),
                   "at least " + dataset::kContactDomainRadius.name() + " = " + digitsOf(domain[m]));
  }
}

/// Patches and mixtures look at all triangles round a node, for each of its neighbours.
void checkTrianglesAtNodes(const ModelView& v, const Checker& check) {
  constexpr int kMost = 1024;
  std::vector<int> count(v.surfaceNodes());
  for (const std::int32_t node : v.surface_triangles) ++count[static_cast<std::size_t>(node)];
  const auto most = std::max_element(count.begin(), count.end());
  check.require(*most <= kMost,
                dataset::kSurfaceTriangles.name() + " has " + std::to_string(*most) + " triangles at node " +
                    std::to_string(most - count.begin()),
                "at most " + std::to_string(kMost));
}

[[gnu::noinline]] void checkPositions(const ModelView& v, const Checker& check) {
  check.require(v.positions() > 0, dataset::kContactNode.name() + " is empty", "contact positions");
  check.indices(dataset::kContactNode.name(), v.contact_node, v.surfaceNodes());
  check.indices(dataset::kPositionOfNode.name(), v.position_of_node, v.positions(), -1);
  for (std::size_t m = 0; m < v.positions(); ++m) {
    const std::int32_t back = v.position_of_node[static_cast<std::size_t>(v.contact_node[m])];
    if (back != static_cast<std::int32_t>(m))
      check.failAt(dataset::kContactNode.name(), m, "leads back to position " + std::to_string(back),
                   std::to_string(m));
    if (v.contact_accessible[m] > 1)
      check.failAt(dataset::kContactAccessible.name(), m, "is " + std::to_string(v.contact_accessible[m]),
                   "0 or 1");
  }
  std::size_t used = 0;
  for (const std::int32_t position : v.position_of_node) used += position >= 0 ? 1 : 0;
  check.require(
      used == v.positions(),
      dataset::kPositionOfNode.name() + " names " + std::to_string(used) + " positions",
      "the " + std::to_string(v.positions()) + " of " + dataset::kContactNode.name() + ", each once");
}

/// Nodes near something, a block for each: where the blocks begin, and that none lists a node twice: a block that did would move
/// it twice in the field and once in a query of that node.
struct NearLists {
  std::string offset_name, node_name;
  std::span<const std::int64_t> offset;
  std::span<const std::int32_t> node;
};

[[gnu::noinline]] void checkNear(const NearLists& near, std::size_t surface_nodes, const Checker& check) {
  const auto end = static_cast<std::int64_t>(near.node.size());
  check.require(near.offset.front() == 0,
                near.offset_name + " begins with " + std::to_string(near.offset.front()), "0");
  for (std::size_t m = 0; m + 1 < near.offset.size(); ++m) {
    const std::int64_t first = near.offset[m], last = near.offset[m + 1];
    if (last < first || last > end || last - first > static_cast<std::int64_t>(surface_nodes))
      check.failAt(near.offset_name, m + 1, "is " + std::to_string(last),
                   "at least " + std::to_string(first) + ", at most " + std::to_string(end) +
                       " and no more than one entry for each surface node");
  }
  check.require(near.offset.back() == end,
                near.offset_name + " ends with " + std::to_string(near.offset.back()),
                "the length of " + near.node_name + ", " + std::to_string(end));
  check.indices(near.node_name, near.node, surface_nodes);
  for (std::size_t m = 0; m + 1 < near.offset.size(); ++m)  // ascending: a tick finds a node by halving
    for (auto i = static_cast<std::size_t>(near.offset[m]) + 1;
         i < static_cast<std::size_t>(near.offset[m + 1]); ++i)
      if (near.node[i] <= near.node[i - 1])
        check.failAt(near.node_name, i, "is " + std::to_string(near.node[i]),
                     "more than " + std::to_string(near.node[i - 1]) + ", the one before it in block " +
                         std::to_string(m));
}

/// Green's functions belong to nodes of the surface.
void checkGreens(const ModelView& v, const Checker& check) {
  check.indices(dataset::kGreenNode.name(), v.green_node, v.surfaceNodes());
  checkNear({dataset::kGreenOffset.name(), dataset::kGreenNearNode.name(), v.green_offset, v.green_near_node},
            v.surfaceNodes(), check);
}

/// Edges are those that the stiffness has middles of; their fields are those of positions to some degree.
void checkEdges(const ModelAttributes& a, const ModelView& v, const Checker& check) {
  if (v.edge_offset.empty()) return;
  const std::size_t E = v.edge_offset.size() - 1, edges = v.places() - std::min(v.places(), v.positions());
  check.require(E == edges && E > 0, dataset::kEdgeScale.name() + " has " + std::to_string(E) + " edges",
                std::to_string(edges) + ", the places of " + dataset::kContactStiffness.name() +
                    " less the contact positions, at least 1");
  const std::size_t Ce = v.edge_scale.size() / E;
  bool whole = false;
  for (int degree = 2; degree <= a.order; ++degree)
    whole = whole || Ce == index(MonomialBasis::size(degree)) - kLinearCoefficients;
  check.require(whole, dataset::kEdgeScale.name() + " has " + std::to_string(Ce) + " coefficients",
                "those of degree 2 to one of at most " + std::to_string(a.order));
  checkNear({dataset::kEdgeOffset.name(), dataset::kEdgeNode.name(), v.edge_offset, v.edge_node},
            v.surfaceNodes(), check);
}

/// Of fields: above zero, and so that every number is finite.
[[gnu::noinline]] void checkScale(const std::string& name, std::span<const float> scale,
                                  const Checker& check) {
  constexpr float kLargest = std::numeric_limits<float>::max() / 32768.0F;
  for (std::size_t i = 0; i < scale.size(); ++i)
    if (!(scale[i] > 0.0F && scale[i] <= kLargest))
      check.failAt(name, i, "is " + digitsOf(double(scale[i])),
                   "more than 0, at most " + digitsOf(double(kLargest)));
}

std::string knownLaws() {
  std::string list;
  for (const std::string_view law : kLaws) list += (list.empty() ? "\"" : " or \"") + std::string(law) + '"';
  return list;
}

void checkRegions(const ModelView& v, const Checker& check) {
  if (v.region_name.empty()) return;
  check.indices(dataset::kElementRegion.name(), v.mesh_element_region, v.region_name.size());
  for (std::size_t r = 0; r < v.region_name.size(); ++r) {
    if (v.region_name[r].front() == '\0') check.failAt(dataset::kRegionName.name(), r, "is empty", "a name");
    if (!(std::isfinite(v.region_E[r]) && v.region_E[r] > 0.0))
      check.failAt(dataset::kRegionE.name(), r, "is " + digitsOf(v.region_E[r]), "more than 0 Pa");
    if (!(v.region_nu[r] > -1.0 && v.region_nu[r] < 0.5))
      check.failAt(dataset::kRegionNu.name(), r, "is " + digitsOf(v.region_nu[r]),
                   "more than -1 and less than 0.5");
    const std::string law = textOf(v.region_law[r]);
    if (std::find(kLaws.begin(), kLaws.end(), law) == kLaws.end())
      check.failAt(dataset::kRegionLaw.name(), r, "is \"" + law + "\"", knownLaws());
  }
}

void checkSprings(const ModelView& v, const Checker& check) {
  check.indices(dataset::kSpringNode.name(), v.spring_node, v.mesh_node_tag.size());
  for (std::size_t s = 0; s < v.spring_stiffness.size(); ++s)
    if (!(std::isfinite(v.spring_stiffness[s]) && v.spring_stiffness[s] > 0.0))
      check.failAt(dataset::kSpringStiffness.name(), s, "is " + digitsOf(v.spring_stiffness[s]),
                   "more than 0 N/m");
}

void checkFinite(const ModelView& v, const Checker& check) {
  check.finite(dataset::kSurfacePositions.name(), v.surface_positions);
  check.finite(dataset::kContactForce.name(), v.contact_force);
  check.finite(dataset::kContactStiffness.name(), v.contact_stiffness);
  check.finite(dataset::kContactDisplacement.name(), v.contact_displacement);
  check.finite(dataset::kContactDomainRadius.name(), v.contact_domain_radius);
  check.finite(dataset::kContactSeriesRadius.name(), v.contact_series_radius);
  check.finite(dataset::kMeshNodes.name(), v.mesh_nodes);
}

}  // namespace

void checkAttributes(const ModelAttributes& a, const std::string& name) {
  const Checker check(name);
  const auto range = [&](const char* attribute, double value, bool good, const std::string& expected) {
    check.require(std::isfinite(value) && good,
                  std::string("attribute ") + attribute + " is " + digitsOf(value), expected);
  };
  check.require(std::find(kLaws.begin(), kLaws.end(), a.law) != kLaws.end(),
                "attribute law is \"" + a.law.substr(0, 40) + "\"", knownLaws());
  if (a.parameters != Parameters::kLevel) checkOrders(a, check);
  range("E", a.E, a.E > 0.0, "more than 0 Pa");
  range("nu", a.nu, a.nu > -1.0 && a.nu < 0.5, "more than -1 and less than 0.5");
  range("patch_radius", a.patch_radius, a.patch_radius > 0.0, "more than 0 m");
  range("near_radius", a.near_radius, a.near_radius >= 0.0, "at least 0 m");
  range("reference_displacement", a.reference_displacement, a.reference_displacement > 0.0, "more than 0 m");
  range("rounded_triangles", a.rounded_triangles,
        a.rounded_triangles >= 1 && a.rounded_triangles <= kMostRoundedTriangles,
        "1 to " + std::to_string(kMostRoundedTriangles));
  if (a.parameters == Parameters::kForce)
    range("reference_force", a.reference_force, a.reference_force > 0.0, "more than 0 N");
  if (a.parameters != Parameters::kLevel) return;
  range("load", a.load, a.load > 0.0, "more than 0 N");
  const double length = Eigen::Map<const Vec3>(a.load_direction.data()).stableNorm();
  check.require(std::abs(length - 1.0) <= 1e-9, "attribute load_direction has length " + digitsOf(length),
                "1");
}

void checkContents(const ModelAttributes& a, const ModelView& v, const std::string& name) {
  const Checker check(name);
  check.require(v.surfaceNodes() > 0 && v.triangles() > 0, "/surface is empty", "a closed surface");
  checkFinite(v, check);
  check.indices(dataset::kSurfaceTriangles.name(), v.surface_triangles, v.surfaceNodes());
  checkTrianglesAtNodes(v, check);
  checkScale(dataset::kModesXScale.name(), v.modes_X_scale, check);
  checkScale(dataset::kModesYScale.name(), v.modes_Y_scale, check);
  checkScale(dataset::kNearScale.name(), v.near_scale, check);
  checkScale(dataset::kGreenYScale.name(), v.green_Y_scale, check);
  checkScale(dataset::kGreenNearScale.name(), v.green_near_scale, check);
  checkScale(dataset::kEdgeScale.name(), v.edge_scale, check);
  checkPositions(v, check);
  checkFaces(v, check);
  checkDomain(a.parameters, v.contact_domain_radius, check);
  checkSeries(v.contact_series_radius, v.contact_domain_radius, check);
  checkNear({dataset::kNearOffset.name(), dataset::kNearNode.name(), v.near_offset, v.near_node},
            v.surfaceNodes(), check);
  if (a.parameters == Parameters::kDisplacement) {
    checkGreens(v, check);
    checkEdges(a, v, check);
  }
  checkLoadDriven(a, v, check);
  const std::size_t N = v.mesh_node_tag.size();
  check.require(N > 0, dataset::kMeshNodes.name() + " is empty", "the volume mesh");
  check.indices(dataset::kMeshTetrahedra.name(), v.mesh_tetrahedra, N);
  check.indices(dataset::kMeshMidsides.name(), v.mesh_midsides, N);
  check.indices(dataset::kMeshFixed.name(), v.mesh_fixed, N);
  check.indices(dataset::kMeshSurfaceNode.name(), v.mesh_surface_node, N);
  checkRegions(v, check);
  checkSprings(v, check);
}

}  // namespace palpate
