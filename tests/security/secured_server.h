// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <ctime>

#include "authority_folder.h"
#include "palpate/idl/certificate.h"
#include "palpate/testing/run_program.h"
#include "tests/server/server_fixture.h"

namespace palpate::server::testing {

namespace fs = std::filesystem;
using palpate::testing::AuthorityFolder;
using palpate::testing::runProgram;

/// A server and a tool with identities of one authority.
class SecuredServer : public ServerEndToEnd {
 public:
  // What a role may, for the certificate in a folder, until a time.
  [[nodiscard]] static std::string permissionsOf(const fs::path& folder, dds::Role role, std::time_t end) {
    const std::string subject = dds::subjectOf(*dds::readCertificate(folder / "identity.pem"));
    return security::permissions(role, subject, dds::utcOf(end - 3600), dds::utcOf(end));
  }

 protected:
  SecuredServer() { identity_ = dds::Identity::load(authority_.of("driver")); }

  // A tool that behaves, already pressing. Answers that came before are forgotten.
  void startSecured(std::vector<std::string> more = {}) {
    more.insert(more.end(), {"--security", authority_.of("server")});
    ASSERT_NO_FATAL_FAILURE(start(more));
    ASSERT_NO_FATAL_FAILURE(press(0.002));
    ASSERT_GT(sizeOf(settled_.force), 0.0) << "flags " << settled_.flags << "\n" << server_->log();
    client_->forget();
  }

  // The same, as a file that the authority signed.
  void writeEnding(const fs::path& folder, dds::Role role, std::time_t end, const fs::path& to) const {
    security::writeSigned(security::permissionsSigner(authority_.folder()), permissionsOf(folder, role, end),
                          to);
  }

  const AuthorityFolder authority_;
};

}  // namespace palpate::server::testing
