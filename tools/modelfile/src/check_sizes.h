// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "palpate/modelfile/model_data.h"

namespace palpate::modelfile {

/// @throw ModelFileError naming the first dataset whose length does not fit the others, found and expected
void checkSizes(const ModelData& data);

}  // namespace palpate::modelfile
