// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "tools/examine/reproduce/output.h"
#include "tools/program/json.h"

namespace palpate::reproduce {

/// The whole document. @param results  {"rod": ..., "beam": ..., "liver": ...}, each as in its results.json,
/// those that ran; @param nested whether figures lie in folders of those names
[[nodiscard]] std::string report(const Json& results, bool nested);

}  // namespace palpate::reproduce
