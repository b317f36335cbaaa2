// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "ellipsoid.h"
#include "palpate/modelfile/model_data.h"

namespace palpate::bench {

/// /modes/X and /modes/Y of an invented model whose surface, attributes and contact positions are there.
void fillModes(const Ellipsoid& surface, int modes, modelfile::ModelData& data);

/// /near of the same.
void fillNear(const Ellipsoid& surface, modelfile::ModelData& data);

}  // namespace palpate::bench
