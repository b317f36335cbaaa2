// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "icosphere.h"
#include "palpate/testing/synthetic_model.h"

namespace palpate::testing {

/// The tetrahedra between surface and centre, and the nodule's region if it has any.
/// @param data  surface and attributes are there
void fillSyntheticMesh(const SyntheticOptions& options, const Icosphere& sphere, modelfile::ModelData& data);

}  // namespace palpate::testing
