// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "palpate/testing/files.h"
#include "palpate/testing/synthetic_model.h"
#include "tools/modelfile/write_model.h"

namespace palpate::testing {

/// A model whose data are spoiled before they are written.
inline MetaModel spoiled(const SyntheticOptions& options,
                         const std::function<void(modelfile::ModelData&)>& spoil) {
  modelfile::ModelData data = syntheticModel(options);
  spoil(data);
  const TemporaryFile file("spoiled.h5");
  modelfile::writeModel(file.path(), data);
  return MetaModel::load(file.path());
}

}  // namespace palpate::testing
