// SPDX-License-Identifier: Apache-2.0
// Which certificate files are taken.
#include "tls.h"

#include <gtest/gtest.h>

#include "palpate/client/error.h"
#include "test_certificate.h"

namespace palpate::viewer {
namespace {

using testing::TestCertificate;

// Why the files are refused; empty: they are taken.
std::string refusalOf(const TlsFiles& files) {
  try {
    check(files);
    return {};
  } catch (const client::ClientError& error) {
    return error.what();
  }
}

TEST(Tls, TakesACertificateWithItsKeyOrNeither) {
  const TestCertificate own;
  EXPECT_EQ(refusalOf({}), "");
  EXPECT_EQ(refusalOf({own.certificate(), own.key()}), "");
  EXPECT_NE(refusalOf({own.certificate(), ""}).find("--tls-key is missing"), std::string::npos);
  EXPECT_NE(refusalOf({"", own.key()}).find("--tls-cert is missing"), std::string::npos);
}

TEST(Tls, NamesTheFileThatIsWrong) {
  const TestCertificate own;
  const TestCertificate other;
  const TestCertificate locked("a password");
  const testing::TemporaryFolder folder;
  const std::string text = folder.write("text.pem", "no certificate");
  const std::string empty = folder.write("empty.pem", "");
  EXPECT_NE(refusalOf({"/nowhere/cert.pem", own.key()}).find("/nowhere/cert.pem"), std::string::npos);
  for (const std::string& wrong : {text, empty, own.key()})
    EXPECT_NE(refusalOf({wrong, own.key()}).find("--tls-cert " + wrong), std::string::npos) << wrong;
  for (const std::string& wrong : {text, empty, own.certificate(), other.key()})
    EXPECT_NE(refusalOf({own.certificate(), wrong}).find("--tls-key " + wrong), std::string::npos) << wrong;
  EXPECT_NE(refusalOf({locked.certificate(), locked.key()}).find("without a password"), std::string::npos);
}

}  // namespace
}  // namespace palpate::viewer
