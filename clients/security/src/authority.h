// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <ctime>
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
/// Modes are set of what is made only. @throw SecurityError, dds::DdsError, program::WriteError  one is there already, others may
/// write the folder or read `private`, or it cannot be written
void makeAuthority(const std::filesystem::path& folder, Days days);

/// Checks what lies in an authority's folder, its keys only where `private` is: that may be kept elsewhere.
/// @return when it ends
/// @throw dds::DdsError naming the file: missing, others may write it or read a key, expired, or not of the others there
std::time_t checkAuthority(const std::filesystem::path& folder);

/// An identity that was made.
struct Issued {
  std::filesystem::path folder;
  std::time_t end;
  bool cut;  ///< earlier than was asked for: its authority ends then
};

/// Makes FOLDER/issued/NAME: what Identity::load() reads.
/// @param[in] days  at most as long as its authority
/// @param[in] renew  replace what is there, all at once; otherwise it is refused
/// @throw SecurityError, dds::DdsError, program::WriteError  no authority there or as checkAuthority(), a name that no file can have,
///        an identity that is there already
Issued issue(const std::filesystem::path& folder, dds::Role role, const std::string& name, Days days,
             bool renew);

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
