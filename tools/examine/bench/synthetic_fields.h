// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tools/examine/bench/ellipsoid.h"
#include "tools/modelfile/model_data.h"

namespace palpate::bench {

/// /modes of a synthetic model that has its surface, attributes and contact positions, and /green/Y of its /green/node.
/// @param load  N, that moves a patch by the reference displacement
void fillModes(const Ellipsoid& surface, int modes, double load, modelfile::ModelData& data);

/// The rest of /near and /green of the same.
void fillNear(const Ellipsoid& surface, double load, modelfile::ModelData& data);

}  // namespace palpate::bench
