// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace palpate::certify {

/// Content as a URI that contains it, in base 64: as an image it loads nothing and runs no script, and its styles are its own.
/// @param type  such as "image/svg+xml"
[[nodiscard]] std::string dataUri(const std::string& type, const std::string& content);

}  // namespace palpate::certify
