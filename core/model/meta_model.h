// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>

#include "core/data/load_error.h"
#include "core/data/model_view.h"
#include "core/data/parameter_functions.h"
#include "core/data/sealed_image.h"
#include "core/data/sha256.h"
#include "core/model/contact_response.h"
#include "core/model/fields.h"
#include "core/model/patch_average.h"
#include "core/model/smooth_mixing.h"
#include "core/surface/contact_surface.h"
#include "core/surface/surface_mesh.h"

namespace palpate {

/// A model file in memory: immutable, checked, mapped, and ready to be evaluated by any number of threads.
class MetaModel {
 public:
  /// Copies the file into sealed memory, checks every size, index and number of the copy and that its digest is
  /// the one that the file states, and maps it read-only, populated, locked where the system allows it
  /// (docs/model_file.md).
  /// @throw LoadError one sentence: file, dataset, found, expected. Real-time: no (reads, allocates).
  [[nodiscard]] static MetaModel load(const std::filesystem::path& path);

  [[nodiscard]] const ModelAttributes& attributes() const noexcept { return attributes_; }
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
  /// How the contact's answers are mixed between contact positions.
  [[nodiscard]] const SmoothMixing& mixing() const noexcept { return mixing_; }
  [[nodiscard]] const SeparatedField& farField() const noexcept { return far_field_; }
  [[nodiscard]] const NearField& nearField() const noexcept { return near_field_; }
  /// What a contact patch feels of a field, for tools that press together.
  [[nodiscard]] const PatchAverage& patchAverage() const noexcept { return patch_average_; }
  /// Size of the file and of its copy in memory, bytes.
  [[nodiscard]] std::size_t bytes() const noexcept { return image_.bytes().size(); }
  /// True when the copy is locked into memory, so that the loop meets no page fault.
  [[nodiscard]] bool locked() const noexcept { return image_.locked(); }

 private:
  MetaModel(SealedImage image, ModelAttributes attributes, const ModelView& view, const Digest& digest);

  SealedImage image_;
  ModelAttributes attributes_;
  ModelView view_;
  Digest digest_;
  ParameterFunctions functions_;
  SurfaceMesh surface_;
  ContactSurface contact_surface_;
  ContactResponse response_;
  SmoothMixing mixing_;
  SeparatedField far_field_;
  NearField near_field_;
  PatchAverage patch_average_;
};

}  // namespace palpate
