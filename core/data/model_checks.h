// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "core/data/model_view.h"

namespace palpate {

/// Ranges of the root attributes. @throw LoadError
void checkAttributes(const ModelAttributes& attributes, const std::string& name);

/// Every index in range, every table consistent, every number finite. @throw LoadError
void checkContents(const ModelAttributes& attributes, const ModelView& view, const std::string& name);

}  // namespace palpate
