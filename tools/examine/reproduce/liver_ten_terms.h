// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tools/examine/reproduce/liver_options.h"
#include "tools/examine/reproduce/output.h"
#include "tools/program/json.h"

namespace palpate::reproduce {

/// The ten terms of Eq. (19) on a coarser liver. Fills results["ten_term"].
void studyTenTerms(const LiverOptions& options, Output& out, Json& results);

}  // namespace palpate::reproduce
