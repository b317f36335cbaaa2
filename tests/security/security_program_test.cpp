// SPDX-License-Identifier: Apache-2.0
// palpate-security: what it makes, with which modes, and what it refuses.
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <filesystem>
#include <fstream>
#include <iterator>

#include "authority.h"
#include "palpate/idl/certificate.h"
#include "palpate/testing/files.h"
#include "palpate/testing/run_program.h"

namespace palpate::dds {
namespace {

namespace fs = std::filesystem;

void expectSaid(const std::string& text, const std::string& part) {
  EXPECT_NE(text.find(part), std::string::npos) << text;
}

TEST(SecurityProgram, MakesChecksAndRefuses) {
  const palpate::testing::TemporaryFolder folder;
  const std::string at = (folder / "a").string();
  const auto run = [](std::vector<std::string> words) {
    return palpate::testing::runProgram("palpate-security", words);
  };
  palpate::testing::expectOneLineError(run({"issue", "driver", "d", "--folder", at}), "holds no authority");
  EXPECT_EQ(run({"init", "--folder", at}).exit_code, 0);
  palpate::testing::expectOneLineError(run({"init", "--folder", at}), "holds an authority already");
  EXPECT_EQ(run({"issue", "driver", "d", "--folder", at}).exit_code, 0);
  palpate::testing::expectOneLineError(run({"issue", "driver", "d", "--folder", at}), "is there already");
  palpate::testing::expectOneLineError(run({"issue", "driver", "../d", "--folder", at}), "name is '../d'");
  EXPECT_EQ(run({"issue", "king", "d", "--folder", at}).exit_code, 2);
  EXPECT_EQ(run({"issue", "viewer", "d", "--renew", "--days", "20", "--folder", at}).exit_code, 0);
  EXPECT_EQ(fs::status(folder / "a/private").permissions(), fs::perms::owner_all);
  const auto valid = run({"check", "--folder", at});
  EXPECT_EQ(valid.exit_code, 0) << valid.out;
  expectSaid(valid.out, "viewer d\n  warning: ");
  fs::permissions(folder / "a/issued/d/identity.key", fs::perms::group_read, fs::perm_options::add);
  const auto broken = run({"check", "--folder", at, "--json"});
  EXPECT_EQ(broken.exit_code, 3);
  expectSaid(broken.out, "others may read it");
  expectSaid(broken.out, "\"valid\":false");
}

class SecurityProgramFiles : public ::testing::Test {
 protected:
  [[nodiscard]] palpate::testing::ProgramResult run(std::vector<std::string> words) const {
    words.insert(words.end(), {"--folder", at_.string()});
    return palpate::testing::runProgram("palpate-security", words);
  }
  [[nodiscard]] static fs::perms modeOf(const fs::path& path) { return fs::status(path).permissions(); }

  const palpate::testing::TemporaryFolder folder_;
  const fs::path at_ = folder_ / "a";
};

TEST_F(SecurityProgramFiles, AFolderThatIsThereKeepsItsMode) {
  fs::create_directory(at_);
  fs::permissions(at_, fs::perms::owner_all);
  EXPECT_EQ(run({"init"}).exit_code, 0);
  EXPECT_EQ(modeOf(at_), fs::perms::owner_all);
}

TEST_F(SecurityProgramFiles, AFolderOfEverybodysIsRefusedAndKeepsItsMode) {
  fs::create_directory(at_);
  const fs::perms everybodys = fs::perms::all | fs::perms::sticky_bit;
  fs::permissions(at_, everybodys);
  palpate::testing::expectOneLineError(run({"init"}), "mode is 1777, others may write it");
  EXPECT_EQ(modeOf(at_), everybodys);
}

TEST_F(SecurityProgramFiles, APrivateFolderThatOthersReadIsRefused) {
  fs::create_directories(at_ / "private");
  fs::permissions(at_ / "private", fs::perms::owner_all | fs::perms::group_read);
  palpate::testing::expectOneLineError(run({"init"}), "private: mode is 0740, others may read it; chmod 700");
}

TEST_F(SecurityProgramFiles, WhatIsMadeIsValidUnderALooseUmask) {
  const mode_t before = umask(0002);
  EXPECT_EQ(run({"init"}).exit_code, 0);
  EXPECT_EQ(run({"issue", "driver", "d"}).exit_code, 0);
  umask(before);
  const auto checked = run({"check"});
  EXPECT_EQ(checked.exit_code, 0) << checked.out;
}

TEST_F(SecurityProgramFiles, AnAuthoritysKeyThatOthersMayReadIsRefused) {
  ASSERT_EQ(run({"init"}).exit_code, 0);
  for (const char* key : {"private/authority.key", "private/permissions_authority.key"}) {
    EXPECT_EQ(run({"check"}).exit_code, 0);
    fs::permissions(at_ / key, fs::perms::group_read, fs::perm_options::add);
    EXPECT_EQ(run({"check"}).exit_code, 3);
    palpate::testing::expectOneLineError(run({"issue", "driver", "d"}), ".key: mode is 0640");
    fs::permissions(at_ / key, fs::perms::group_read, fs::perm_options::remove);
  }
}

TEST_F(SecurityProgramFiles, AnAuthorityWithoutItsKeysIsValidAndIssuesNothing) {
  ASSERT_EQ(run({"init"}).exit_code, 0);
  fs::rename(at_ / "private", folder_ / "elsewhere");
  EXPECT_EQ(run({"check"}).exit_code, 0);
  palpate::testing::expectOneLineError(run({"issue", "driver", "d"}), "authority.key: cannot be read");
}

TEST_F(SecurityProgramFiles, AnExpiredAuthorityIsNotValidAndIssuesNothing) {
  security::makeAuthority(at_, {0});
  const auto checked = run({"check"});
  EXPECT_EQ(checked.exit_code, 3);
  expectSaid(checked.out, "authority.pem: expired on ");
  palpate::testing::expectOneLineError(run({"issue", "driver", "d"}),
                                       "palpate-security init --folder ANOTHER");
}

TEST_F(SecurityProgramFiles, AnIdentityEndsNotAfterItsAuthority) {
  ASSERT_EQ(run({"init", "--days", "10"}).exit_code, 0);
  expectSaid(run({"issue", "driver", "d", "--days", "20"}).out, ", when its authority ends; copy it");
  const X509Ptr certificate = readCertificate(at_ / "issued/d/identity.pem");
  EXPECT_EQ(endOf(*certificate), endOf(*readCertificate(at_ / "permissions_authority.pem")));
  EXPECT_EQ(run({"issue", "driver", "e", "--days", "9"}).out.find("when its authority ends"),
            std::string::npos);
}

TEST_F(SecurityProgramFiles, ARenewedIdentityReplacesTheWholeFolder) {
  ASSERT_EQ(run({"init"}).exit_code, 0);
  ASSERT_EQ(run({"issue", "driver", "d"}).exit_code, 0);
  std::ofstream(at_ / "issued/d/of_before") << "x";
  ASSERT_EQ(run({"issue", "driver", "d", "--renew"}).exit_code, 0);
  EXPECT_FALSE(fs::exists(at_ / "issued/d/of_before"));
  EXPECT_EQ(std::distance(fs::directory_iterator(at_ / "issued"), fs::directory_iterator()), 1);
  EXPECT_EQ(modeOf(at_ / "issued/d"), fs::perms::owner_all);
}

TEST_F(SecurityProgramFiles, ANameBeginsWithALetterOrDigit) {
  ASSERT_EQ(run({"init"}).exit_code, 0);
  palpate::testing::expectOneLineError(run({"issue", "driver", "_d"}), "name is '_d'");
}

}  // namespace
}  // namespace palpate::dds
