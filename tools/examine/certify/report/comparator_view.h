// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tools/program/json.h"

namespace palpate::certify {

/// A row of a table of errors: `what`, `p50`, `p95`, `max`, `bound`, as texts. @param error  of a certificate, or null
[[nodiscard]] program::Json errorRow(const char* what, const program::Json& error);

/// Adds what the page says of the touches and their full solutions: of one tool, and of two.
/// @param content  of contentOf()  @throw program::JsonError
void addComparatorView(const program::Json& content, program::Json& view);

}  // namespace palpate::certify
