// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "tools/modelfile/model_data.h"

namespace palpate::modelfile {

/// C, the number of coefficients of the fields. @throw ModelFileError when the data do not tell
[[nodiscard]] std::size_t fieldCoefficients(const ModelData& data);

/// @throw ModelFileError naming the first dataset whose length does not fit the others, found and expected
void checkSizes(const ModelData& data);

}  // namespace palpate::modelfile
