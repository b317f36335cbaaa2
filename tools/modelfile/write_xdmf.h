// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

namespace palpate::modelfile {

/// Writes `model.xdmf` beside the model (extension replaced): rest surface with each mode X_k as a vector
/// attribute, read by ParaView out of the model file itself. The model is checked by MetaModel::load first.
/// @return path of the .xdmf. @throw LoadError, ModelFileError
std::filesystem::path writeXdmf(const std::filesystem::path& model);

}  // namespace palpate::modelfile
