// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "tools/program/json.h"

namespace palpate::certify {

/// The report's page: page.html with what it names. Texts are escaped; control characters become question marks.
/// @param view  of pageViewOf()
[[nodiscard]] std::string pageOf(const program::Json& view);

}  // namespace palpate::certify
