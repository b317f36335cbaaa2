// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "survey.h"
#include "tools/program/json.h"

namespace palpate::list {

/// For people: each server with its organ and its tools, and who sends poses to none of them.
[[nodiscard]] std::string textOf(const Listing& listing);
/// The object of --json (docs/json.md).
[[nodiscard]] program::Json jsonOf(const Listing& listing);

}  // namespace palpate::list
