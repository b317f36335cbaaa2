// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "core/model/meta_model.h"

namespace palpate::modelfile {

/// Writes a model with another E, every region and spring scaled alike: what the solver would give for these, to rounding.
/// Force and stiffness go with E, unit loads move the organ by its inverse; modes, near fields and radii stay. The model's
/// certificate is of another content and is left out.                                  docs/model_file.md
/// @param model  driven by displacement  @param E  of the root, Pa, > 0  @param provenance  text of a JSON object
/// @throw ModelFileError naming the file that cannot be written, or numbers that overflow at that E
void writeScaled(const std::filesystem::path& path, const MetaModel& model, double E,
                 const std::string& provenance);

}  // namespace palpate::modelfile
