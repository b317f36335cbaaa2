// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tools/examine/bench/ellipsoid.h"
#include "tools/modelfile/model_data.h"

namespace palpate::bench {

/// /modes/X and /modes/Y of a synthetic model that has its surface, attributes and contact positions.
void fillModes(const Ellipsoid& surface, int modes, modelfile::ModelData& data);

/// /near of the same.
void fillNear(const Ellipsoid& surface, modelfile::ModelData& data);

}  // namespace palpate::bench
