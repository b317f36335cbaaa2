// SPDX-License-Identifier: Apache-2.0
#include "core/model/meta_model.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "core/data/available_memory.h"
#include "core/data/model_checks.h"
#include "core/data/model_content.h"
#include "core/data/model_reader.h"
#include "core/data/try_in_child.h"

namespace palpate {

namespace {

void compare(const std::string& name, const char* what, const std::string& stored, const Digest& computed) {
  if (stored != computed.hex())
    throw LoadError(name + ": the " + what + " of its content is " + computed.hex() + ", the file says " +
                    stored.substr(0, 64) + ": it was damaged or changed after it was written");
}

/// At most about what the model's tables take beside the copy: modes node by node in float32, their averages over
/// patches and the patches themselves, the contact's answer in rows, and the refined surface with its
/// search tree.
std::uint64_t bytesOfTables(const ModelView& v) {
  constexpr std::uint64_t kRefined = 96U << 20U;  // of the 300,000 triangles that it may have
  constexpr std::uint64_t kPerNode =
      2200;  // of a surface that has more after one refinement, while it is made
  constexpr std::uint64_t kPerEntry =
      3 * sizeof(float);  // of a patch: node and weight, one of them there twice as it grows
  const std::uint64_t entries = std::min<std::uint64_t>(
      PatchAverage::kMostTogether, v.positions() * std::min(v.surfaceNodes(), PatchAverage::kMostNodes));
  const std::uint64_t averages = 3 * sizeof(float) * v.positions() * v.modes();
  return 2 * v.modes_X.size_bytes() + averages + v.contact_force.size_bytes() +
         v.contact_displacement.size_bytes() + kRefined + kPerNode * v.surfaceNodes() + kPerEntry * entries;
}

/// The content is what the writer wrote. @return its digest
Digest verified(const ModelContents& contents, const std::string& name) {
  const std::string& provenance = contents.attributes.provenance;
  compare(name, "provenance_digest", contents.stored.provenance,
          sha256(std::as_bytes(std::span<const char>(provenance))));
  const Digest digest = contentDigest(contents.attributes, contents.view);
  compare(name, "digest", contents.stored.content, digest);
  if (contents.attributes.certificate.empty()) return digest;
  compare(name, "certificate_digest", contents.stored.certificate,
          sha256(std::as_bytes(std::span<const char>(contents.attributes.certificate))));
  if (contents.stored.certified != digest.hex())
    throw LoadError(name + ": the certificate belongs to the content " +
                    contents.stored.certified.substr(0, 64) + ", the digest of this content is " +
                    digest.hex());
  return digest;
}

}  // namespace

MetaModel MetaModel::load(const std::filesystem::path& path) {
  SealedImage image(path);  // first: later changes of the file do not reach the copy that was checked
  const auto read = [&] { return readModel(image, path.string()); };
  tryInChild(path.string(), image.bytes().size(), [&] { (void)read(); });  // HDF5 trusts what it reads
  ModelContents contents = read();
  requireMemory(path, "what is computed from it", bytesOfTables(contents.view));
  const Digest digest = verified(contents, path.string());
  checkContents(contents.attributes, contents.view, path.string());
  try {
    return MetaModel(std::move(image), std::move(contents.attributes), contents.view, digest);
  } catch (const std::invalid_argument& error) {
    throw LoadError(path.string() + ": " + error.what());
  }
}

MetaModel::MetaModel(SealedImage image, ModelAttributes attributes, const ModelView& view,
                     const Digest& digest)
    : image_(std::move(image)),
      attributes_(std::move(attributes)),
      view_(view),
      digest_(digest),
      functions_(view_, attributes_, attributes_.order),
      surface_(view_),
      contact_surface_(view_, surface_),
      response_(view_, attributes_),
      mixing_(view_, surface_),
      far_field_(view_),
      near_field_(view_),
      patch_average_(view_, attributes_) {}

}  // namespace palpate
