// SPDX-License-Identifier: Apache-2.0
// A model from a file that may be hostile.
#include <algorithm>
#include <memory>
#include <utility>

#include "core/data/ask_reader.h"
#include "core/data/available_memory.h"
#include "core/data/model_answer.h"
#include "core/data/model_reader.h"
#include "core/data/region_surfaces.h"
#include "core/data/sealed_image.h"
#include "core/model/meta_model.h"

namespace palpate {

namespace {

/// At most about what the model's tables take beside the copy: what is near the nodes that patches are
/// centred at, the stiffness of patches over triangles, the contact's answer in rows, dimples, and the refined surface with
/// its search tree; and what the server makes of regions.
std::uint64_t bytesOfTables(const ModelView& v) {
  constexpr std::uint64_t kRefined = 96U << 20U;  // of kMostRoundedTriangles
  constexpr std::uint64_t kPerNode =
      2200;                               // of a surface that has more after one refinement, while it is made
  constexpr std::uint64_t kPerEntry = 8;  // of a patch
  constexpr std::uint64_t kPiece = 1U << 20U;  // of the patches' list, with room to spare
  const std::uint64_t entries =
      std::min<std::uint64_t>(ContactPatches::kMostTogether,
                              v.surfaceNodes() * std::min(v.surfaceNodes(), ContactPatches::kMostNodes));
  // Six places a triangle are seen from it, twice as the lists are made; each place, four a node, has a dimple of degree one.
  const std::uint64_t places = 2 * 6 * v.triangles() * sizeof(SmoothPlaces::View) +
                               4 * v.surfaceNodes() * sizeof(Eigen::Matrix3f) + 3 * v.edge_scale.size_bytes();
  return places + v.triangles() * sizeof(SmoothCubic<6>) + v.contact_stiffness.size_bytes() +
         v.modes_Y_scale.size_bytes() * 3 + v.contact_force.size_bytes() +
         v.contact_displacement.size_bytes() + kRefined + kPiece + kPerNode * v.surfaceNodes() +
         kPerEntry * entries + kRegionSurfaceBytes * v.mesh_element_region.size();
}

}  // namespace

MetaModel MetaModel::load(const std::filesystem::path& path) {
  // First: later changes of the file do not reach the copy that is checked.
  return load(std::make_shared<const SealedImage>(path), path.string());
}

MetaModel MetaModel::load(const std::shared_ptr<const SealedImage>& image, const std::string& name,
                          const ReaderProcess& process) {
  ModelContents contents = readModel(AnsweredModel(*image, name, askReader(*image, name, process)), name);
  requireMemory(name, "what is computed from it", bytesOfTables(contents.view));
  const ModelDigests digests = digestsOf(contents);
  return of({image, image->bytes().size(), image->locked()}, std::move(contents), digests, name);
}

}  // namespace palpate
