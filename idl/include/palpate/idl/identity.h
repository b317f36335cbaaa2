// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <ctime>
#include <filesystem>
#include <initializer_list>
#include <optional>
#include <string>

#include "palpate/idl/qos.h"
#include "palpate/idl/role.h"

namespace palpate::dds {

/// What lies in an identity's folder, which palpate-security issue makes and --security names.
namespace identity_file {
inline constexpr const char* kAuthority = "authority.pem";  ///< certificate of who signs identities
inline constexpr const char* kPermissionsAuthority =
    "permissions_authority.pem";  ///< certificate of who signs governance and permissions, and nothing else
inline constexpr const char* kGovernance = "governance.p7s";    ///< how topics are protected, signed
inline constexpr const char* kCertificate = "identity.pem";     ///< OU is the role, CN the name
inline constexpr const char* kKey = "identity.key";             ///< private: mode 0600
inline constexpr const char* kPermissions = "permissions.p7s";  ///< what the role writes, until when, signed
}  // namespace identity_file

/// Who a participant is on a domain whose topics are signed and encrypted: DDS Security (OMG, version 1.1), with the files of a
/// folder. Checked before DDS sees them, since DDS says little of what is wrong.
class Identity {
 public:
  /// @throw DdsError naming the file, what is wrong and what to do: a file is missing, a key may be read, a file or the folder written by
  ///        others, a certificate or permissions are not the authority's, not of each other, not valid yet or expired
  [[nodiscard]] static Identity load(const std::filesystem::path& folder);

  [[nodiscard]] const std::filesystem::path& folder() const noexcept { return folder_; }
  [[nodiscard]] Role role() const noexcept { return role_; }
  [[nodiscard]] const std::string& name() const noexcept { return name_; }
  /// When the first of both authorities, certificate and permissions ends.
  [[nodiscard]] std::time_t expires() const noexcept { return expires_; }

  /// What to do about its end, "palpate-security ... makes a new one".
  [[nodiscard]] const std::string& remedy() const noexcept { return remedy_; }

  /// One line from 30 days before expires() on, else empty.
  [[nodiscard]] std::string warning(std::time_t now = std::time(nullptr)) const;

  /// Tells DDS. @throw DdsError  Cyclone DDS has no security plugins here
  void applyTo(dds_qos_t& qos) const;

 private:
  std::filesystem::path folder_;
  Role role_{Role::kViewer};
  std::string name_, remedy_;
  std::time_t expires_{0};
};

/// Whether a participant was made with an identity.
[[nodiscard]] bool hasIdentity(dds_entity_t participant);

/// The identity in a folder, for a program of certain roles. @return nothing when `folder` is empty
/// @throw DdsError as Identity::load(), or the identity is of another role
[[nodiscard]] std::optional<Identity> identityFor(std::initializer_list<Role> roles,
                                                  const std::filesystem::path& folder);

}  // namespace palpate::dds
