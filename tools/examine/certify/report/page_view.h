// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tools/examine/certify/report/pictures.h"
#include "tools/program/json.h"

namespace palpate::certify {

/// What the page's template names: texts, and lists of objects of texts. Nothing in them is escaped yet; pictures are data URIs.
/// @param content  of contentOf()  @throw program::JsonError
[[nodiscard]] program::Json pageViewOf(const program::Json& content, const Figures& figures);

}  // namespace palpate::certify
