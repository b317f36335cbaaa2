// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>

#include "core/data/ask_reader.h"
#include "core/data/load_error.h"
#include "core/data/model_digests.h"
#include "core/data/model_reader.h"
#include "core/data/model_view.h"
#include "core/data/parameter_functions.h"
#include "core/data/sha256.h"
#include "core/model/contact_dimple.h"
#include "core/model/contact_response.h"
#include "core/model/fields.h"
#include "core/model/linear_field.h"
#include "core/model/patch_stiffness.h"
#include "core/model/smooth_mixing.h"
#include "core/surface/contact_patches.h"
#include "core/surface/contact_surface.h"
#include "core/surface/smooth_places.h"
#include "core/surface/surface_mesh.h"

namespace palpate {

/// The memory that a model's arrays lie in.
struct ModelImage {
  std::shared_ptr<const void> memory;
  std::size_t bytes{0};
  bool locked{false};  ///< so that the loop meets no page fault
};

/// A model file in memory: immutable, checked, mapped, and ready to be evaluated by any number of threads (but see DimpleTable).
class MetaModel {
 public:
  /// Copies the file into sealed memory and maps it read-only, populated, locked where the system allows it. Another process
  /// parses the copy (core/data/ask_reader.h). Every size, index and number is checked, and that the digest is the one that the
  /// file states (docs/model_file.md).
  /// @throw LoadError one sentence: file, dataset, found, expected. Real-time: no (reads, allocates).
  [[nodiscard]] static MetaModel load(const std::filesystem::path& path);
  /// The same of a copy that was made already. @param name  how it is called in messages  @throw LoadError
  [[nodiscard]] static MetaModel load(const std::shared_ptr<const SealedImage>& image,
                                      const std::string& name, const ReaderProcess& process = {});
  /// A model whose arrays lie in memory already. @param digests  computed of these  @param name  how it is called in messages
  /// @param dimple  kWhenTouched: for one thread  @throw LoadError  as load(), for numbers and digests. Real-time: no.
  [[nodiscard]] static MetaModel of(ModelImage image, ModelContents contents, const ModelDigests& digests,
                                    const std::string& name, DimpleTable dimple = DimpleTable::kAtLoad);

  [[nodiscard]] const ModelAttributes& attributes() const noexcept { return attributes_; }
  [[nodiscard]] bool isDisplacementDriven() const noexcept {
    return attributes_.parameters == Parameters::kDisplacement;
  }
  [[nodiscard]] const ModelView& view() const noexcept { return view_; }
  /// Of the content, computed at load: two models with the same one give the same answers.
  [[nodiscard]] const Digest& digest() const noexcept { return digest_; }
  /// What names the model to people and on the wire, hexadecimal.
  [[nodiscard]] std::string id() const { return digest_.id(); }
  /// The first 8 bytes of the digest, big endian.
  [[nodiscard]] std::uint64_t contentHash() const noexcept { return digest_.leading64(); }
  /// The functions of the parameter that the fields are sums of.
  [[nodiscard]] const ParameterFunctions& functions() const noexcept { return functions_; }
  [[nodiscard]] const SurfaceMesh& surface() const noexcept { return surface_; }
  /// What tools slide on.
  [[nodiscard]] const ContactSurface& contactSurface() const noexcept { return contact_surface_; }
  [[nodiscard]] const ContactResponse& response() const noexcept { return response_; }
  /// Degree 1 of the contact's answer, of a "displacement" model.
  [[nodiscard]] const PatchStiffness& stiffness() const noexcept { return stiffness_; }
  /// How the contact's answers are mixed between contact positions.
  [[nodiscard]] const SmoothMixing& mixing() const noexcept { return mixing_; }
  [[nodiscard]] const SeparatedField& farField() const noexcept { return far_field_; }
  /// Of contact positions, by functions; of a "displacement" model those of orders two and more.
  [[nodiscard]] const Amplitudes& amplitudes() const noexcept { return amplitudes_; }
  [[nodiscard]] const NearField& nearField() const noexcept { return near_field_; }
  /// What edge midpoints add, by edge in the order of places(), orders of two and more. docs/design.md, Parts
  [[nodiscard]] const NearField& edgeField() const noexcept { return edge_field_; }
  /// Ce, how many of these coefficients edges have; 0 where they add nothing.
  [[nodiscard]] std::size_t edgeCoefficients() const noexcept { return edge_coefficients_; }
  /// Degree 1 of a "displacement" model's field.
  [[nodiscard]] const LinearField& linearField() const noexcept { return linear_field_; }
  /// [Ns] 1: a tool may touch the surface there. Contact positions say it of corners; a node between two such is one too.
  [[nodiscard]] std::vector<std::uint8_t> accessibleNodes() const;
  /// [Ns] 1: clamped, so that it does not move.
  [[nodiscard]] std::vector<std::uint8_t> clampedNodes() const;
  /// The field at a tool's own anchor, of a "displacement" model.
  [[nodiscard]] const ContactDimple& dimple() const noexcept { return dimple_; }
  /// What its numbers are made of.
  [[nodiscard]] ContactDimple::Parts dimpleParts() const noexcept PALPATE_NONBLOCKING;
  /// The nodes that a tool holds, wherever it is.
  [[nodiscard]] const ContactPatches& patches() const noexcept { return patches_; }
  /// How far their nodes are from their middle at most, m.
  [[nodiscard]] double reachOfPatches() const noexcept { return 3.0 * attributes_.patch_radius; }
  /// How far near fields of contact positions reach at most, m.
  [[nodiscard]] double reachOfNearFields() const noexcept { return near_reach_; }
  /// How far what edges add reaches from their midpoints at most, m.
  [[nodiscard]] double reachOfEdges() const noexcept { return edge_reach_; }
  /// Asks the cache for what a tick of a contact reads, so that it comes together and not piece by piece. @param s, fine  the
  /// anchor, of the rest surface and of the contact surface, in a triangle. Real-time: yes.
  void expect(const ContactPoint& s, const ContactPoint& fine) const noexcept PALPATE_NONBLOCKING;
  /// Where smooth functions of the contact position are known.
  [[nodiscard]] const SmoothPlaces& places() const noexcept { return places_; }
  /// Size of the file and of its copy in memory, bytes.
  [[nodiscard]] std::size_t bytes() const noexcept { return image_.bytes; }
  /// True when the copy is locked into memory, so that the loop meets no page fault.
  [[nodiscard]] bool locked() const noexcept { return image_.locked; }

 private:
  MetaModel(ModelImage image, ModelContents contents, const Digest& digest, DimpleTable dimple);

  ModelImage image_;
  std::shared_ptr<const void> copies_;  // of arrays that are stored in fewer bytes
  ModelAttributes attributes_;
  ModelView view_;
  Digest digest_;
  ParameterFunctions functions_;
  SurfaceMesh surface_;
  SmoothPlaces places_;
  ContactSurface contact_surface_;
  ContactResponse response_;
  PatchStiffness stiffness_;
  SmoothMixing mixing_;
  ContactPatches patches_;
  SeparatedField far_field_;
  Amplitudes amplitudes_;
  NearField near_field_;
  double near_reach_;
  std::size_t edge_coefficients_;
  NearField edge_field_;
  double edge_reach_;
  LinearField linear_field_;
  ContactDimple dimple_;
};

}  // namespace palpate
