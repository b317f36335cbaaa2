// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <stdexcept>
#include <string>

#include "palpate/idl/role.h"

namespace palpate::security {

/// What cannot be made, in one line.
class SecurityError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

inline constexpr const char* kPrivate = "private";  ///< folder of the authority's key, mode 0700
inline constexpr const char* kAuthorityKey = "authority.key";
inline constexpr const char* kIssued = "issued";  ///< folder of the identities, by name

/// A span of validity. It begins an hour ago: clocks of machines differ.
struct Days {
  int count;
};

/// Makes an authority: authority.pem, governance.p7s, private/authority.key, and the empty folder `issued`.
/// Keys are elliptic, P-256; signatures SHA-256.
/// @throw SecurityError  one is there already, or the folder cannot be written
void makeAuthority(const std::filesystem::path& folder, Days days);

/// Makes FOLDER/issued/NAME: what Identity::load() reads.
/// @param[in] renew  replace what is there; otherwise it is refused
/// @return the identity's folder
/// @throw SecurityError, dds::DdsError  no authority there, a name that no file can have, an identity that is there already
std::filesystem::path issue(const std::filesystem::path& folder, dds::Role role, const std::string& name,
                            Days days, bool renew);

/// Signs a document by the authority in a folder (S/MIME) and writes it.
/// @throw SecurityError, dds::DdsError, program::WriteError  no authority there, or the file cannot be written
void writeSigned(const std::filesystem::path& authority, const std::string& document,
                 const std::filesystem::path& to);

/// XML, as DDS Security 1.1 has it: how topics are protected on all domains.
[[nodiscard]] std::string governance();
/// What a role may write and read, on all domains. @param[in] start, end  as utcOf() has them
[[nodiscard]] std::string permissions(dds::Role role, const std::string& subject, const std::string& start,
                                      const std::string& end);

}  // namespace palpate::security
