// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace palpate::testing {

/// Why a text is not well-formed XML as far as our writers use it (elements, attributes in double quotes, the
/// five entities, a declaration); empty when it is.
[[nodiscard]] std::string xmlFault(const std::string& text);

}  // namespace palpate::testing
