// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/data/checker.h"
#include "core/data/model_view.h"

namespace palpate {

/// What only models have whose parameter is a load: no near field, and levels that rise. @throw LoadError
void checkLoadDriven(const ModelAttributes& attributes, const ModelView& view, const Checker& check);

}  // namespace palpate
