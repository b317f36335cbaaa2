// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "palpate/idl/types.h"

namespace palpate::client {

/// What a program's --organ-id says of itself.
inline constexpr const char* kOrganIdHelp =
    "which organ of the domain, by the id that its server gave it; default: any";

/// The largest ids.
inline constexpr std::int64_t kMaxServerId = std::int64_t{dds::kServerAny} - 1;
inline constexpr std::int64_t kMaxOrganId = 4294967295;

/// Which of the servers on a domain is meant: by its id, by that of its organ, by both, or any.
struct WantedServer {
  std::uint32_t server_id{dds::kServerAny};
  std::optional<std::int64_t> organ_id;

  [[nodiscard]] bool any() const noexcept { return server_id == dds::kServerAny && !organ_id; }
  [[nodiscard]] bool fits(const dds::ServerStatus& status) const noexcept {
    return (server_id == dds::kServerAny || status.server_id == server_id) &&
           (!organ_id || status.organ_id == *organ_id);
  }
};

/// "server", "server 3", "server 3 with organ 1" or "server with organ 1".
[[nodiscard]] inline std::string nameOf(const WantedServer& wanted) {
  std::string name = "server";
  if (wanted.server_id != dds::kServerAny) name.append(" ").append(std::to_string(wanted.server_id));
  if (wanted.organ_id) name.append(" with organ ").append(std::to_string(*wanted.organ_id));
  return name;
}

}  // namespace palpate::client
