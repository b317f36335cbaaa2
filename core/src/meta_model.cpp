// SPDX-License-Identifier: Apache-2.0
#include "palpate/core/meta_model.h"

#include <stdexcept>
#include <utility>

#include "model_checks.h"
#include "model_reader.h"

namespace palpate {

MetaModel MetaModel::load(const std::filesystem::path& path) {
  SealedImage image(path);  // first: later changes of the file do not reach the copy that was checked
  ModelContents contents = readModel(image, path.string());
  checkContents(contents.attributes, contents.view, path.string());
  try {
    return MetaModel(std::move(image), std::move(contents.attributes), contents.view);
  } catch (const std::invalid_argument& error) {
    throw LoadError(path.string() + ": " + error.what());
  }
}

MetaModel::MetaModel(SealedImage image, ModelAttributes attributes, const ModelView& view)
    : image_(std::move(image)),
      attributes_(std::move(attributes)),
      view_(view),
      functions_(view_, attributes_, attributes_.order),
      surface_(view_),
      contact_surface_(view_, surface_),
      response_(view_, attributes_),
      mixing_(view_, surface_),
      far_field_(view_),
      near_field_(view_),
      patch_average_(view_, attributes_) {}

}  // namespace palpate
