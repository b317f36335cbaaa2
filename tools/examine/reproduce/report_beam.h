// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "tools/examine/reproduce/output.h"
#include "tools/program/json.h"

namespace palpate::reproduce {

/// The chapter on the beam: paper and ours side by side. @param figures  path from the report to the figures, "" or "beam/"
[[nodiscard]] std::string beamChapter(const Json& results, const std::string& figures);

}  // namespace palpate::reproduce
