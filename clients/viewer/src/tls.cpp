// SPDX-License-Identifier: Apache-2.0
#include "tls.h"

#include <openssl/err.h>
#include <openssl/ssl.h>

#include <fstream>
#include <memory>

#include "palpate/client/error.h"

namespace palpate::viewer {
namespace {

[[noreturn]] void refuse(const std::string& option, const std::string& file, const std::string& expected) {
  const unsigned long code = ERR_peek_last_error();
  const char* reason = code == 0 ? nullptr : ERR_reason_error_string(code);
  ERR_clear_error();
  throw client::ClientError(option + " " + file + " is not " + expected +
                            (reason ? " (" + std::string(reason) + ")" : ""));
}

void checkReadable(const std::string& option, const std::string& file) {
  if (!std::ifstream(file).good() || std::ifstream(file).peek() == std::ifstream::traits_type::eof())
    throw client::ClientError(option + " " + file + " cannot be read, or is empty");
}

int noPassword(char*, int, int, void*) {
  return 0;
}

}  // namespace

void check(const TlsFiles& files) {
  if (files.certificate.empty() != files.key.empty())
    throw client::ClientError(std::string(files.key.empty() ? "--tls-key" : "--tls-cert") +
                              " is missing: TLS needs --tls-cert and --tls-key");
  if (!files.given()) return;
  checkReadable("--tls-cert", files.certificate);
  checkReadable("--tls-key", files.key);
  const std::unique_ptr<SSL_CTX, decltype(&SSL_CTX_free)> context(SSL_CTX_new(TLS_server_method()),
                                                                  &SSL_CTX_free);
  if (!context) throw client::ClientError("OpenSSL does not start");
  SSL_CTX_set_default_passwd_cb(context.get(), &noPassword);  // the terminal is not asked
  if (SSL_CTX_use_certificate_chain_file(context.get(), files.certificate.c_str()) != 1)
    refuse("--tls-cert", files.certificate, "a certificate in PEM that OpenSSL takes");
  if (SSL_CTX_use_PrivateKey_file(context.get(), files.key.c_str(), SSL_FILETYPE_PEM) != 1)
    refuse("--tls-key", files.key, "the certificate's key in PEM, without a password");
}

}  // namespace palpate::viewer
