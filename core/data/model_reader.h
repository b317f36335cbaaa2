// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include "core/data/model_source.h"
#include "core/data/model_view.h"

namespace palpate {

/// The digests that the writer put into the file, as text.
struct StoredDigests {
  std::string content;
  std::string provenance;
  std::string certificate;  ///< of its text; empty without one, as the next
  std::string certified;    ///< of the content that it belongs to
};

/// What a source says about a model: its attributes, and where its arrays lie in memory.
struct ModelContents {
  ModelAttributes attributes;
  StoredDigests stored;
  ModelView view;
  std::shared_ptr<const void> copies{};  ///< what the view needs beside where the arrays lie
};

/// Format, attributes and each array's type, shape and place, all of them checked. The numbers in the arrays are not looked at:
/// see checkContents().
/// @param name  how the file is called in messages
/// @throw LoadError file, dataset, found, expected
[[nodiscard]] ModelContents readModel(const ModelSource& file, const std::string& name);

}  // namespace palpate
