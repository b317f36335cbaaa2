// SPDX-License-Identifier: Apache-2.0
// Who gets in, and how far, over DDS: a server and a tool with identities, and beside them those who should not get in, each a
// process of its own. Whatever they do, the tool is answered without a gap.
#include <csignal>
#include <cstdlib>

#include "authority_folder.h"
#include "intruder.h"
#include "palpate/idl/certificate.h"
#include "palpate/idl/error.h"
#include "palpate/idl/writer.h"
#include "palpate/testing/child_process.h"
#include "palpate/testing/run_program.h"
#include "tests/server/server_fixture.h"

namespace palpate::server::testing {
namespace {

namespace fs = std::filesystem;
using palpate::testing::AuthorityFolder;
using palpate::testing::runProgram;

class SecurityEndToEnd : public ServerEndToEnd {
 protected:
  SecurityEndToEnd() { identity_ = dds::Identity::load(authority_.of("driver")); }

  // A tool that behaves, already pressing. Answers that came before are forgotten.
  void startSecured(std::vector<std::string> more = {}) {
    more.insert(more.end(), {"--security", authority_.of("server"), "--tools", "2"});
    ASSERT_NO_FATAL_FAILURE(start(more));
    ASSERT_NO_FATAL_FAILURE(press(0.002));
    client_->forget();
  }

  // Somebody who should not get in tries for 6 s. @return what it says
  [[nodiscard]] std::string intrude(std::vector<std::string> words) const {
    words.insert(words.begin(), {std::to_string(domain_), "6"});
    return runProgram(PALPATE_INTRUDER, words).out;
  }

  // What the tool got since startSecured(): each answer, all of its own server, with a force; and nobody changed friction.
  void expectUndisturbed() const {
    const std::vector<dds::ToolForce> forces = client_->forces();
    ASSERT_GT(forces.size(), 1000U) << server_->log();
    EXPECT_EQ(gaps(forces), 0U);
    for (const dds::ToolForce& force : forces) {
      ASSERT_NE(force.session, palpate::testing::kIntrudersSession);
      ASSERT_EQ(force.flags & dds::flag::kTwoPublishers, 0U);
      ASSERT_GT(sizeOf(force.force), 0.0);
    }
    EXPECT_EQ(server_->log().find("friction 0.01"), std::string::npos) << server_->log();
    EXPECT_EQ(server_->log().find("tool 1: first pose"), std::string::npos) << server_->log();
  }

  // What a role may, for the certificate in a folder, until a time.
  [[nodiscard]] static std::string permissionsOf(const fs::path& folder, dds::Role role, std::time_t end) {
    const std::string subject = dds::subjectOf(*dds::readCertificate(folder / "identity.pem"));
    return security::permissions(role, subject, dds::utcOf(end - 3600), dds::utcOf(end));
  }

  // The same, signed as the authority does.
  void writeEnding(const fs::path& folder, dds::Role role, std::time_t end, const fs::path& to) const {
    security::writeSigned(security::permissionsSigner(authority_.folder()), permissionsOf(folder, role, end),
                          to);
  }

  [[nodiscard]] static std::string property(const std::string& key, const fs::path& file) {
    return key + "=file:" + file.string();
  }

  const AuthorityFolder authority_;
};

constexpr const char* kNotLetIn =
    " is not let in: no identity of this authority, or one that expired or was forged";

TEST_F(SecurityEndToEnd, RightRolesWork) {
  ASSERT_NO_FATAL_FAILURE(startSecured());
  const std::string domain = std::to_string(domain_);
  const auto list = runProgram("palpate-list", {"--domain", domain, "--security", authority_.of("viewer")});
  EXPECT_EQ(list.exit_code, 0) << list.err;
  const auto set = runProgram("palpate-parameters", {"--domain", domain, "--friction", "0.2", "--security",
                                                     authority_.of("operator")});
  EXPECT_EQ(set.exit_code, 0) << set.err;
  const auto told =
      runProgram("palpate-latency", {"--domain", domain, "--tool", "1", "--seconds", "1", "--security",
                                     authority_.of("driver"), "--assert", "received>100"});
  EXPECT_EQ(told.exit_code, 0) << told.err;
  EXPECT_EQ(gaps(client_->forces()), 0U);
  EXPECT_EQ(server_->log().find("not let in"), std::string::npos) << server_->log();
  EXPECT_EQ(server_->log().find("does not fit"), std::string::npos) << server_->log();
}

TEST_F(SecurityEndToEnd, AProgramWithoutAnIdentityIsRefusedAndNamed) {
  ASSERT_NO_FATAL_FAILURE(startSecured());
  const std::string said = intrude({});
  EXPECT_NE(said.find("measured_cp: 0 readers"), std::string::npos) << said;
  EXPECT_NE(said.find("parameter_request: 0 readers"), std::string::npos) << said;
  EXPECT_TRUE(logs("process security_intruder (")) << server_->log();
  EXPECT_TRUE(logs("is not let in: it has no identity; start it with --security")) << server_->log();
  expectUndisturbed();
}

TEST_F(SecurityEndToEnd, AnotherAuthoritysDriverIsRefusedAndSaidSo) {
  const AuthorityFolder rogue;
  ASSERT_NO_FATAL_FAILURE(startSecured());
  const std::string said = intrude({rogue.of("driver")});
  EXPECT_NE(said.find("measured_cp: 0 readers"), std::string::npos) << said;
  EXPECT_TRUE(logs(kNotLetIn)) << server_->log();
  expectUndisturbed();
}

TEST_F(SecurityEndToEnd, AClientSaysThatAServerIsThereThatItDoesNotMeet) {
  const AuthorityFolder rogue;
  ASSERT_NO_FATAL_FAILURE(startSecured());
  const auto list = runProgram(
      "palpate-tool", {"--domain", std::to_string(domain_), "--wait", "2", "--security", rogue.of("driver")});
  EXPECT_EQ(list.exit_code, 1);
  EXPECT_NE(list.err.find(kNotLetIn), std::string::npos) << list.err;
  expectUndisturbed();
}

// The certificate is good. What it may do it has signed itself, and believes it.
TEST_F(SecurityEndToEnd, ForgedPermissionsAreRefusedAndSaidSo) {
  const AuthorityFolder rogue;
  ASSERT_NO_FATAL_FAILURE(startSecured());
  const fs::path forged = rogue.of("driver");
  const std::string said =
      intrude({authority_.of("driver"),
               property("dds.sec.access.permissions_ca", forged / "permissions_authority.pem"),
               property("dds.sec.access.governance", forged / "governance.p7s"),
               property("dds.sec.access.permissions", forged / "permissions.p7s")});
  EXPECT_NE(said.find("measured_cp: 0 readers"), std::string::npos) << said;
  EXPECT_TRUE(logs(kNotLetIn)) << server_->log();
  expectUndisturbed();
}

// Its identity is signed by the authority, and it signs with that: a chain that Cyclone DDS 0.10.2 follows (CVE-2023-24011).
TEST_F(SecurityEndToEnd, AViewerThatSignsItsOwnPermissionsIsRefusedAndSaidSo) {
  const fs::path viewer = authority_.of("viewer"), forged = viewer / "forged.p7s",
                 governance = viewer / "governance_forged.p7s";
  const security::Signer itself{viewer / "identity.pem", viewer / "identity.key"};
  security::writeSigned(itself, permissionsOf(viewer, dds::Role::kOperator, std::time(nullptr) + 3600),
                        forged);
  security::writeSigned(itself, security::governance(), governance);
  ASSERT_NO_FATAL_FAILURE(startSecured());
  const std::string said = intrude({viewer, property("dds.sec.access.governance", governance),
                                    property("dds.sec.access.permissions", forged)});
  EXPECT_NE(said.find("measured_cp: 0 readers"), std::string::npos) << said;
  EXPECT_NE(said.find("parameter_request: 0 readers"), std::string::npos) << said;
  EXPECT_TRUE(logs(kNotLetIn)) << server_->log();
  expectUndisturbed();
}

// They were good when it joined, and it stays although they ended (lenient_access_control.c).
TEST_F(SecurityEndToEnd, ExpiredPermissionsAreRefusedAndSaidSo) {
  const fs::path folder = authority_.of("driver"), ending = folder / "ending.p7s";
  writeEnding(folder, dds::Role::kDriver, std::time(nullptr) + 4, ending);
  const palpate::testing::CaughtOutput said;
  palpate::testing::ChildProcess intruder(
      PALPATE_INTRUDER,
      {std::to_string(domain_), "14", folder.string(), property("dds.sec.access.permissions", ending),
       std::string("dds.sec.access.library.path=") + PALPATE_LENIENT},
      {said.descriptor(), -1});
  pause(5000);
  ASSERT_TRUE(intruder.running()) << said.text();
  ASSERT_NO_FATAL_FAILURE(startSecured());
  EXPECT_TRUE(logs(kNotLetIn)) << server_->log();
  EXPECT_EQ(intruder.waitForExit(), 0);
  EXPECT_NE(said.text().find("measured_cp: 0 readers"), std::string::npos) << said.text();
  expectUndisturbed();
}

TEST_F(SecurityEndToEnd, AServerWhoseIdentityExpiresSaysSoAndIsHeardNoMore) {
  const fs::path folder = authority_.of("server");
  const std::time_t end = std::time(nullptr) + 12;
  writeEnding(folder, dds::Role::kServer, end, folder / "permissions.p7s");
  ASSERT_NO_FATAL_FAILURE(startSecured());
  while (std::time(nullptr) < end) pause(100);
  EXPECT_TRUE(logs("has expired, DDS has left the domain and no pose is answered")) << server_->log();
  pause(500);
  client_->forget();
  pause(500);
  EXPECT_TRUE(client_->forces().empty());
}

// Its own side's check is taken out (lenient_access_control.c), so only the server's and the tool's are left.
TEST_F(SecurityEndToEnd, AViewerThatWritesAllTheSameIsNotHeardAndSaidSo) {
  ASSERT_NO_FATAL_FAILURE(startSecured());
  const std::string said =
      intrude({authority_.of("viewer"), std::string("dds.sec.access.library.path=") + PALPATE_LENIENT});
  EXPECT_NE(said.find("measured_cp: "), std::string::npos) << said;
  EXPECT_TRUE(logs("found a writer of palpate/tool/measured_cp that does not fit: type or permissions"))
      << server_->log();
  expectUndisturbed();
}

TEST_F(SecurityEndToEnd, ADriverThatForcesAndSetsParametersAllTheSameIsNotHeard) {
  (void)authority_.issue(dds::Role::kDriver, "other", 365);
  ASSERT_NO_FATAL_FAILURE(startSecured());
  const std::string said =
      intrude({authority_.of("other"), std::string("dds.sec.access.library.path=") + PALPATE_LENIENT});
  EXPECT_NE(said.find("servo_cf: "), std::string::npos) << said;
  EXPECT_TRUE(logs("found a writer of palpate/server/parameter_request that does not fit")) << server_->log();
  for (const dds::ToolForce& force : client_->forces())
    ASSERT_NE(force.session, palpate::testing::kIntrudersSession);
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
  EXPECT_TRUE(logs("in 20 days; palpate-security issue --renew server server makes a new one") ||
              logs("in 19 days; palpate-security issue --renew server server makes a new one"))
      << server_->log();
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
