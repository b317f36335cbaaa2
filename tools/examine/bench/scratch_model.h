// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/model/meta_model.h"
#include "tools/modelfile/model_data.h"

namespace palpate::bench {

/// Writes the data as a model file, loads it as the server does, and removes the file again. @throw
/// ModelFileError, LoadError
[[nodiscard]] MetaModel throughFile(const modelfile::ModelData& data);

}  // namespace palpate::bench
