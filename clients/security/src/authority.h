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

inline constexpr const char* kPrivate = "private";  ///< folder of the authority's keys, mode 0700
inline constexpr const char* kAuthorityKey = "authority.key";
inline constexpr const char* kPermissionsKey = "permissions_authority.key";
inline constexpr const char* kIssued = "issued";  ///< folder of the identities, by name

/// A span of validity. It begins an hour ago: clocks of machines differ.
struct Days {
  int count;
};

/// Makes an authority, two keys with their certificates: authority.pem signs identities, permissions_authority.pem governance and
/// permissions. Beside them governance.p7s, `private` with the keys, and the empty folder `issued`.
/// Keys are elliptic, P-256; signatures SHA-256.
/// @throw SecurityError  one is there already, or the folder cannot be written
void makeAuthority(const std::filesystem::path& folder, Days days);

/// Makes FOLDER/issued/NAME: what Identity::load() reads.
/// @param[in] renew  replace what is there; otherwise it is refused
/// @return the identity's folder
/// @throw SecurityError, dds::DdsError  no authority there, a name that no file can have, an identity that is there already
std::filesystem::path issue(const std::filesystem::path& folder, dds::Role role, const std::string& name,
                            Days days, bool renew);

/// Who signs a document: PEM files.
struct Signer {
  std::filesystem::path certificate, key;
};

/// Who signs governance and permissions of the authority in a folder.
[[nodiscard]] Signer permissionsSigner(const std::filesystem::path& authority);

/// Signs a document (S/MIME, the signer's certificate in it) and writes it.
/// @throw SecurityError, dds::DdsError, program::WriteError  a PEM file cannot be read, or the file cannot be written
void writeSigned(const Signer& signer, const std::string& document, const std::filesystem::path& to);

/// XML, as DDS Security 1.1 has it: how topics are protected on all domains.
[[nodiscard]] std::string governance();
/// What a role may write and read, on all domains. @param[in] start, end  as utcOf() has them
[[nodiscard]] std::string permissions(dds::Role role, const std::string& subject, const std::string& start,
                                      const std::string& end);

}  // namespace palpate::security
