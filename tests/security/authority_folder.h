// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "authority.h"
#include "palpate/testing/files.h"

namespace palpate::testing {

/// An authority of this test's own, with an identity of each role that is named like it.
class AuthorityFolder {
 public:
  AuthorityFolder() {
    security::makeAuthority(folder(), {30});
    for (const dds::Role role : dds::kRoles) (void)issue(role, std::string(dds::wordOf(role)), 365);
  }
  /// @return the identity's folder. @param[in] days  0: expired as soon as it is made
  std::filesystem::path issue(dds::Role role, const std::string& name, int days) const {
    return security::issue(folder(), role, name, {days}, true).folder;
  }
  [[nodiscard]] std::filesystem::path folder() const { return folder_ / "authority"; }
  /// "server", "driver", "viewer" or "operator"
  [[nodiscard]] std::string of(const std::string& name) const {
    return (folder() / security::kIssued / name).string();
  }

 private:
  TemporaryFolder folder_;
};

}  // namespace palpate::testing
