// SPDX-License-Identifier: Apache-2.0
// What is refused before DDS sees it, and what is told.
#include "palpate/idl/identity.h"

#include <gtest/gtest.h>
#include <openssl/x509v3.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>

#include "authority_folder.h"
#include "palpate/idl/certificate.h"
#include "palpate/idl/error.h"
#include "palpate/idl/topics.h"

namespace palpate::dds {
namespace {

namespace fs = std::filesystem;
using palpate::testing::AuthorityFolder;
using palpate::testing::contentOf;

class IdentityTest : public ::testing::Test {
 protected:
  // What a driver's identity is refused with.
  [[nodiscard]] std::string refusal() const {
    try {
      (void)Identity::load(folder_);
    } catch (const DdsError& error) {
      return error.what();
    }
    return "not refused";
  }
  void replace(const std::string& name, const std::string& from, const std::string& to) const {
    std::string text = contentOf(folder_ / name);
    const std::size_t at = text.find(from);
    ASSERT_NE(at, std::string::npos) << text;
    std::ofstream(folder_ / name) << text.replace(at, from.size(), to);
  }

  const AuthorityFolder authority_;
  const fs::path folder_ = authority_.of("driver");
};

void expectContains(const std::string& text, const std::string& part) {
  EXPECT_NE(text.find(part), std::string::npos) << text;
}

TEST_F(IdentityTest, SaysItsRoleItsNameAndItsEnd) {
  const Identity identity = Identity::load(folder_);
  EXPECT_EQ(identity.role(), Role::kDriver);
  EXPECT_EQ(identity.name(), "driver");
  EXPECT_NEAR(static_cast<double>(identity.expires() - std::time(nullptr)), 30 * 86400.0, 60.0)
      << "its authority ends first";
}

TEST_F(IdentityTest, WarnsFromThirtyDaysBeforeItsEnd) {
  (void)authority_.issue(Role::kDriver, "driver", 20);
  const Identity identity = Identity::load(folder_);
  EXPECT_EQ(identity.warning(identity.expires() - 30 * 86400), "");
  expectContains(identity.warning(identity.expires() - 30 * 86400 + 1),
                 "in 29 days; palpate-security issue --renew driver driver");
}

TEST_F(IdentityTest, SaysThatARenewalDoesNotHelpWhereItsAuthorityEnds) {
  const Identity identity = Identity::load(folder_);
  expectContains(identity.warning(identity.expires() - 86400),
                 "in 1 days; its authority ends then: palpate-security init --folder ANOTHER");
}

TEST_F(IdentityTest, AKeyThatOthersMayReadIsRefused) {
  fs::permissions(folder_ / "identity.key", fs::perms::group_read, fs::perm_options::add);
  expectContains(refusal(), "identity.key: mode is 0640, others may read it; chmod 600 ");
}

TEST_F(IdentityTest, AnAuthorityThatOthersMayReplaceIsRefused) {
  fs::permissions(folder_ / "authority.pem", fs::perms::others_write, fs::perm_options::add);
  expectContains(refusal(), "authority.pem: mode is 0646, others may write it");
}

TEST_F(IdentityTest, AFolderThatOthersMayWriteIsRefused) {
  fs::permissions(folder_, fs::perms::group_write, fs::perm_options::add);
  expectContains(refusal(), "/driver: mode is 0720, others may write it; chmod go-w ");
}

TEST_F(IdentityTest, AFolderThatCannotBeReachedIsOneLine) {
  fs::remove_all(folder_);
  expectContains(refusal(), "/driver: No such file or directory");
  fs::create_directory_symlink(folder_, folder_);
  expectContains(refusal(), "/driver: Too many levels of symbolic links");
}

TEST_F(IdentityTest, AKeyOfAnotherUserIsRefused) {
  if (geteuid() != 0) GTEST_SKIP() << "only root may give files away";
  ASSERT_EQ(chown((folder_ / "identity.key").c_str(), 1, 1), 0);
  expectContains(refusal(),
                 "identity.key: belongs to user 1, expected the user who runs this program, or root");
}

TEST_F(IdentityTest, EachMissingFileIsNamed) {
  for (const char* name : {"authority.pem", "permissions_authority.pem", "governance.p7s", "identity.pem",
                           "identity.key", "permissions.p7s"}) {
    const fs::path away = folder_ / "away";
    fs::rename(folder_ / name, away);
    expectContains(refusal(), std::string(name) + ": No such file");
    fs::rename(away, folder_ / name);
  }
  EXPECT_EQ(refusal(), "not refused");
}

TEST_F(IdentityTest, PermissionsThatWereChangedAreRefused) {
  replace("permissions.p7s", "palpate/tool/announcement", "palpate/server/parameter_request");
  expectContains(refusal(), "permissions.p7s: not signed by the authority");
}

// The authority signed its certificate, and that may sign nothing.
TEST_F(IdentityTest, PermissionsAndGovernanceThatAnIdentitySignedAreRefused) {
  const fs::path viewer = authority_.of("viewer");
  const security::Signer itself{viewer / "identity.pem", viewer / "identity.key"};
  const std::string subject = subjectOf(*readCertificate(folder_ / "identity.pem"));
  const std::time_t now = std::time(nullptr);
  const std::string kept = contentOf(folder_ / "permissions.p7s");
  security::writeSigned(itself,
                        security::permissions(Role::kServer, subject, utcOf(now - 60), utcOf(now + 3600)),
                        folder_ / "permissions.p7s");
  expectContains(refusal(), "permissions.p7s: not signed by the authority");
  std::ofstream(folder_ / "permissions.p7s") << kept;
  EXPECT_EQ(refusal(), "not refused");
  security::writeSigned(itself, security::governance(), folder_ / "governance.p7s");
  expectContains(refusal(), "governance.p7s: not signed by the authority");
}

// Where somebody takes authority.pem for permissions_ca all the same.
TEST_F(IdentityTest, ItsCertificateAndTheAuthoritysSignNoDocuments) {
  const auto signs = [&](const std::string& file) {
    return X509_check_purpose(readCertificate(folder_ / file).get(), X509_PURPOSE_SMIME_SIGN, 0);
  };
  EXPECT_EQ(signs("identity.pem"), 0);
  EXPECT_EQ(signs("authority.pem"), 0);
  EXPECT_EQ(signs("permissions_authority.pem"), 1);
  EXPECT_EQ(X509_check_ca(readCertificate(folder_ / "permissions_authority.pem").get()), 0);
}

TEST_F(IdentityTest, GovernanceThatWasChangedIsRefused) {
  replace("governance.p7s", "participants>false", "participants>true");
  expectContains(refusal(), "governance.p7s: not signed by the authority");
}

TEST_F(IdentityTest, PermissionsOfAnotherAreRefused) {
  fs::copy_file(fs::path(authority_.of("operator")) / "permissions.p7s", folder_ / "permissions.p7s",
                fs::copy_options::overwrite_existing);
  expectContains(
      refusal(),
      "subject_name is CN=operator,OU=operator,O=palpate, the certificate beside it is of CN=driver");
}

TEST_F(IdentityTest, AnotherAuthoritysCertificateIsRefused) {
  const AuthorityFolder rogue;
  fs::copy_file(fs::path(rogue.of("driver")) / "identity.pem", folder_ / "identity.pem",
                fs::copy_options::overwrite_existing);
  expectContains(refusal(), "identity.pem: not signed by the authority");
}

TEST_F(IdentityTest, AnotherOnesKeyIsRefused) {
  fs::copy_file(fs::path(authority_.of("server")) / "identity.key", folder_ / "identity.key",
                fs::copy_options::overwrite_existing);
  expectContains(refusal(), "identity.key: not the key of identity.pem");
}

TEST_F(IdentityTest, AnExpiredOneIsRefused) {
  (void)authority_.issue(Role::kDriver, "driver", 0);
  expectContains(refusal(), "identity.pem: expired on ");
}

TEST_F(IdentityTest, TheAuthoritysOwnFolderIsNoIdentity) {
  try {
    (void)Identity::load(authority_.folder());
    FAIL();
  } catch (const DdsError& error) {
    expectContains(error.what(), "the folder of an authority, expected one that it issued");
  }
}

TEST_F(IdentityTest, AProgramTakesItsOwnRolesOnly) {
  EXPECT_FALSE(identityFor({Role::kServer}, "").has_value());
  EXPECT_TRUE(identityFor({Role::kServer, Role::kDriver}, folder_).has_value());
  try {
    (void)identityFor({Role::kServer, Role::kViewer}, folder_);
    FAIL();
  } catch (const DdsError& error) {
    expectContains(error.what(), "driver has the role driver, this program needs server or viewer");
  }
}

TEST(Role, OnlyAServerForcesAndAViewerWritesNothing) {
  for (const Role role : kRoles) {
    EXPECT_EQ(mayWrite(role, TopicTraits<ToolForce>::kName), role == Role::kServer);
    EXPECT_EQ(mayWrite(role, TopicTraits<ServerStatus>::kName), role == Role::kServer);
    EXPECT_EQ(mayWrite(role, TopicTraits<ParameterRequest>::kName), role == Role::kOperator);
    EXPECT_EQ(mayWrite(role, TopicTraits<ToolAnnouncement>::kName), role == Role::kDriver);
    EXPECT_EQ(mayWrite(role, TopicTraits<ToolPose>::kName), role == Role::kDriver || role == Role::kOperator);
    EXPECT_EQ(roleOf(wordOf(role)), role);
  }
  EXPECT_TRUE(topicsWrittenBy(Role::kViewer).empty());
  EXPECT_EQ(roleOf("root"), std::nullopt);
}

}  // namespace
}  // namespace palpate::dds
