// SPDX-License-Identifier: Apache-2.0
// What a server with an identity says of itself, and what a role's own side refuses.
#include "palpate/idl/error.h"
#include "palpate/idl/writer.h"
#include "secured_server.h"

namespace palpate::server::testing {
namespace {

using SecurityEndToEnd = SecuredServer;

// Before it ends the server is to be up, which takes seconds where the machine is busy.
TEST_F(SecurityEndToEnd, AServerWhoseIdentityExpiresSaysSoAndIsHeardNoMore) {
  const fs::path folder = authority_.of("server");
  writeEnding(folder, dds::Role::kServer, std::time(nullptr) + 12, folder / "permissions.p7s");
  ASSERT_NO_FATAL_FAILURE(startSecured());
  EXPECT_TRUE(logs("has expired, DDS has left the domain and no pose is answered", 30)) << server_->log();
  const auto silent = [&] {
    client_->forget();
    pause(200);
    return client_->forces().empty();
  };
  bool is_silent = false;
  for (int i = 0; i < 25 && !is_silent; ++i) is_silent = silent();
  EXPECT_TRUE(is_silent);
  EXPECT_TRUE(silent()) << "it is heard again";
}

TEST_F(SecurityEndToEnd, ARoleMakesNoWriterThatItMayNotHave) {
  const auto refuses = [&](const std::string& role, auto writer) {
    const dds::Participant participant(domain_, dds::Identity::load(authority_.of(role)));
    EXPECT_THROW(writer(participant), dds::DdsError) << role;
  };
  const auto poses = [](const auto& p) { dds::Writer<dds::ToolPose>{p}; };
  const auto forces = [](const auto& p) { dds::Writer<dds::ToolForce>{p}; };
  const auto requests = [](const auto& p) { dds::Writer<dds::ParameterRequest>{p}; };
  refuses("viewer", poses);
  refuses("viewer", requests);
  refuses("driver", requests);
  refuses("driver", forces);
  refuses("operator", forces);
  refuses("server", poses);
}

TEST_F(SecurityEndToEnd, AServerTellsThatItsIdentityEnds) {
  (void)authority_.issue(dds::Role::kServer, "server", 20);
  ASSERT_NO_FATAL_FAILURE(startSecured());
  EXPECT_TRUE(logs("days; palpate-security issue --renew server server makes a new one")) << server_->log();
  EXPECT_TRUE(logs("in 19 days") || logs("in 20 days")) << server_->log();
}

TEST_F(SecurityEndToEnd, AServerDoesNotStartWithWhatIsWrong) {
  const std::string model = model_.string(), domain = std::to_string(domain_);
  const auto start_with = [&](const std::string& folder) {
    return runProgram("palpate-server", {"--model", model, "--domain", domain, "--security", folder});
  };
  EXPECT_EQ(start_with(authority_.of("driver")).exit_code, 1);
  EXPECT_NE(start_with(authority_.of("driver")).err.find("this program needs server"), std::string::npos);
  fs::permissions(fs::path(authority_.of("server")) / "identity.key", fs::perms::others_read,
                  fs::perm_options::add);
  const auto refused = start_with(authority_.of("server"));
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_NE(refused.err.find("others may read it; chmod 600"), std::string::npos) << refused.err;
}

}  // namespace
}  // namespace palpate::server::testing
