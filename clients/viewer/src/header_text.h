// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

namespace palpate::viewer {

/// The secret in an Authorization header "Bearer ..."; empty when there is none.
[[nodiscard]] std::string_view bearerIn(std::string_view header);

/// Value of a cookie in a Cookie header; empty when absent.
[[nodiscard]] std::string_view cookieIn(std::string_view header, std::string_view name);

/// Whether a comma-separated list has the name.
[[nodiscard]] bool names(std::string_view list, std::string_view name);

}  // namespace palpate::viewer
