// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace palpate::dds {

/// What an identity may do on a domain whose topics are signed (docs/security.md). All roles read all topics.
enum class Role { kServer, kDriver, kViewer, kOperator };

inline constexpr std::array kRoles{Role::kServer, Role::kDriver, Role::kViewer, Role::kOperator};

/// "server", "driver", "viewer" or "operator".
[[nodiscard]] std::string_view wordOf(Role role) noexcept;
[[nodiscard]] std::optional<Role> roleOf(std::string_view word) noexcept;

/// Names of the topics that a role writes. This is the only list: permissions are made from it.
[[nodiscard]] std::vector<std::string_view> topicsWrittenBy(Role role);
[[nodiscard]] bool mayWrite(Role role, std::string_view topic);

/// "driver or operator".
[[nodiscard]] std::string wordsOf(std::initializer_list<Role> roles);

}  // namespace palpate::dds
