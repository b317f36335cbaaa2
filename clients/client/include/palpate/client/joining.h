// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <initializer_list>

#include "palpate/idl/participant.h"

namespace palpate::client {

/// What a program's --security says of itself.
inline constexpr const char* kSecurityHelp =
    "folder with this program's identity (palpate-security issue), where topics are signed and encrypted; "
    "default: they are not";

/// Programs that only read.
inline constexpr std::initializer_list<dds::Role> kReaders{dds::Role::kViewer, dds::Role::kDriver,
                                                           dds::Role::kOperator};

/// Joins a domain. One line on standard error when the identity ends within 30 days.
/// @param[in] security  the identity's folder; empty: none  @param[in] roles  which it may have
/// @throw dds::DdsError as dds::identityFor() and dds::Participant
[[nodiscard]] dds::Participant join(std::uint32_t domain, const std::filesystem::path& security,
                                    std::initializer_list<dds::Role> roles);

}  // namespace palpate::client
