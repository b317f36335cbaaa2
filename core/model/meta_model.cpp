// SPDX-License-Identifier: Apache-2.0
#include "core/model/meta_model.h"

#include <algorithm>
#include <stdexcept>
#include <utility>
#include <vector>

#include "core/base/index.h"
#include "core/data/datasets.h"
#include "core/data/model_checks.h"
#include "core/data/model_content.h"
#include "core/surface/surface_distance.h"

namespace palpate {

namespace {

void compare(const std::string& name, const char* what, const std::string& stored, const Digest& computed) {
  if (stored != computed.hex())
    throw LoadError(name + ": the " + what + " of its content is " + computed.hex() + ", the file says " +
                    stored.substr(0, 64) + ": it was damaged or changed after it was written");
}

/// By surface node: whether it may carry load.
std::vector<std::uint8_t> freeNodes(const ModelView& view) {
  std::vector<std::uint8_t> fixed(view.mesh_nodes.size() / 3, 0), free;
  for (const std::int32_t node : view.mesh_fixed) fixed[index(node)] = 1;
  for (const std::int32_t node : view.mesh_surface_node) free.push_back(fixed[index(node)] == 0 ? 1 : 0);
  return free;
}

/// The nodes of all triangles where the model answers, also of those that have a corner without a contact position.
std::vector<std::int32_t> centresOf(const ModelView& view) {
  std::vector<std::uint8_t> in(view.surfaceNodes(), 0);
  for (std::size_t t = 0; t < view.contactTriangles(); ++t) {
    const std::span<const std::int32_t> corner = view.contact_triangles.subspan(3 * t, 3);
    const auto answers = [&](std::int32_t node) { return view.position_of_node[index(node)] >= 0; };
    if (std::any_of(corner.begin(), corner.end(), answers))
      for (const std::int32_t node : corner) in[index(node)] = 1;
  }
  std::vector<std::int32_t> nodes;
  for (std::size_t i = 0; i < in.size(); ++i)
    if (in[i] != 0) nodes.push_back(static_cast<std::int32_t>(i));
  return nodes;
}

ContactPatches patchesOf(const ModelView& view, const ModelAttributes& attributes) {
  constexpr double kLeastRadius = 1e-9;  // m; below, its square vanishes, and no mesh is that fine
  return {SurfaceGraph(view.surface_positions, view.surface_triangles, view.contact_triangles),
          freeNodes(view), std::max(attributes.patch_radius, kLeastRadius), centresOf(view)};
}

/// Each node that a patch may load has its Green's function, or both ends of its edge have: without it the field would lack
/// what it carries.
void checkLoadedNodes(const ModelView& view, const ContactPatches& patches, const LinearField& field) {
  std::vector<std::uint8_t> loaded(view.surfaceNodes(), 0);
  for (const std::int32_t centre : view.contact_node) patches.markNear(centre, loaded);
  for (std::size_t node = 0; node < loaded.size(); ++node)
    if (loaded[node] != 0 && !field.carries(static_cast<std::int32_t>(node)))
      throw std::invalid_argument(dataset::kGreenNode.name() + " lacks node " + std::to_string(node) +
                                  ", expected every node that contact patches load, or the ends of its edge");
}

/// Dimples are summed from the amplitudes of all patches: some seconds at this most, 50,000 nodes of 216 in a patch and 370
/// modes; and from those of all edges, 16 coefficients of 150,000 edges and 400 modes.
void checkDimpleWork(const ModelView& view, const ModelAttributes& attributes, const ContactPatches& patches,
                     const LinearField& field) {
  constexpr std::size_t kMost = 4'000'000'000, kMostOfEdges = 1'000'000'000;
  const std::size_t for_each = view.modes() * (field.sharesLoads() ? 2 : 1);  // of the modes' amplitudes
  if (for_each > 0 && patches.entries() > kMost / for_each)
    throw std::invalid_argument("patch_radius is " + std::to_string(attributes.patch_radius) +
                                " m, expected one of patches with at most " +
                                std::to_string(kMost / for_each) + " nodes together for " +
                                std::to_string(view.modes()) + " modes, found " +
                                std::to_string(patches.entries()));
  if (view.modes() > 0 && view.edge_scale.size() > kMostOfEdges / view.modes())
    throw std::invalid_argument(dataset::kEdgeScale.name() + " has " +
                                std::to_string(view.edge_scale.size()) + " numbers, expected at most " +
                                std::to_string(kMostOfEdges / view.modes()) + " for " +
                                std::to_string(view.modes()) + " modes");
}

/// By edge, of those that add something to fields; none where no edge does.
std::vector<Vec3> edgeMidpoints(const SurfaceMesh& surface, const SmoothPlaces& places,
                                const ModelView& view) {
  std::vector<Vec3> points;
  for (std::size_t place = view.positions(); !view.edge_offset.empty() && place < places.size(); ++place)
    points.push_back(surface.position(places.views(place).front().s));
  return points;
}

std::size_t modeRows(const ModelView& view) {
  return view.modes_Y_scale.size() / view.positions();
}

std::size_t edgeRows(const ModelView& view) {
  return view.edge_offset.empty() ? 0 : view.edge_scale.size() / (view.edge_offset.size() - 1);
}

/// The content is what the writer wrote.
void verify(const ModelContents& contents, const ModelDigests& computed, const std::string& name) {
  const StoredDigests& stored = contents.stored;
  compare(name, "provenance_digest", stored.provenance, computed.provenance);
  compare(name, "digest", stored.content, computed.content);
  if (contents.attributes.certificate.empty()) return;
  compare(name, "certificate_digest", stored.certificate, computed.certificate);
  if (stored.certified != computed.content.hex())
    throw LoadError(name + ": the certificate belongs to the content " + stored.certified.substr(0, 64) +
                    ", the digest of this content is " + computed.content.hex());
}

}  // namespace

MetaModel MetaModel::of(ModelImage image, ModelContents contents, const ModelDigests& digests,
                        const std::string& name, DimpleTable dimple) {
  verify(contents, digests, name);
  checkContents(contents.attributes, contents.view, name);
  try {
    return MetaModel(std::move(image), std::move(contents), digests.content, dimple);
  } catch (const std::invalid_argument& error) {
    throw LoadError(name + ": " + error.what());
  }
}

void MetaModel::expect(const ContactPoint& s, const ContactPoint& fine) const noexcept PALPATE_NONBLOCKING {
  contact_surface_.expect(fine.triangle);
  for (const std::int32_t position : mixing_.expect(s.triangle)) response_.expect(position);
  stiffness_.expect(s.triangle);
  surface_.expect(s.triangle);
  dimple_.expect(places_.of(s.triangle));
}

std::vector<std::uint8_t> MetaModel::accessibleNodes() const {
  std::vector<std::uint8_t> accessible(view_.surfaceNodes(), 0);
  for (std::size_t m = 0; m < view_.positions(); ++m)
    accessible[index(view_.contact_node[m])] = view_.contact_accessible[m];
  for (std::size_t t = 0; view_.contactTriangles() < view_.triangles() && t < view_.contactTriangles(); ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      const auto corner = [&](std::size_t turn) {
        return accessible[index(view_.contact_triangles[3 * t + (k + turn) % 3])];
      };
      if (corner(1) != 0 && corner(2) != 0) accessible[index(view_.surface_triangles[12 * t + 9 + k])] = 1;
    }
  return accessible;
}

std::vector<std::uint8_t> MetaModel::clampedNodes() const {
  std::vector<std::uint8_t> clamped = freeNodes(view_);
  for (std::uint8_t& node : clamped) node = node == 0 ? 1 : 0;
  return clamped;
}

MetaModel::MetaModel(ModelImage image, ModelContents contents, const Digest& digest, DimpleTable dimple)
    : image_(std::move(image)),
      copies_(std::move(contents.copies)),
      attributes_(std::move(contents.attributes)),
      view_(contents.view),
      digest_(digest),
      functions_(view_, attributes_, attributes_.order),
      surface_(view_),
      places_(view_.surface_positions, view_.contact_triangles, view_.position_of_node),
      contact_surface_(view_, surface_, index(attributes_.rounded_triangles)),
      response_(view_, attributes_),
      stiffness_(view_, attributes_, places_),
      mixing_(view_, surface_),
      patches_(patchesOf(view_, attributes_)),
      far_field_(view_),
      amplitudes_(view_.modes_Y, view_.modes_Y_scale, modeRows(view_), view_.positionModes()),
      near_field_({view_.near_offset, view_.near_node}, view_.near_field, view_.near_scale, modeRows(view_)),
      near_reach_(
          near_field_.reach(pointsOf(view_.surface_positions, view_.contact_node), view_.surface_positions)),
      edge_coefficients_(edgeRows(view_)),
      edge_field_({view_.edge_offset, view_.edge_node}, view_.edge_field, view_.edge_scale,
                  edge_coefficients_),
      edge_reach_(edge_field_.reach(edgeMidpoints(surface_, places_, view_), view_.surface_positions)),
      linear_field_(view_) {
  if (!isDisplacementDriven()) return;
  checkLoadedNodes(view_, patches_, linear_field_);
  checkDimpleWork(view_, attributes_, patches_, linear_field_);
  dimple_ = ContactDimple(dimpleParts(), dimple);
}

ContactDimple::Parts MetaModel::dimpleParts() const noexcept PALPATE_NONBLOCKING {
  return {view_,
          surface_,
          places_,
          patches_,
          stiffness_,
          mixing_,
          far_field_,
          amplitudes_,
          near_field_,
          edge_field_,
          linear_field_,
          index(functions_.size()),
          edge_coefficients_,
          functions_.reference()};
}

}  // namespace palpate
