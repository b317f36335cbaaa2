// SPDX-License-Identifier: Apache-2.0
#include "test_certificate.h"

#include <openssl/ec.h>
#include <openssl/pem.h>
#include <openssl/ssl.h>
#include <openssl/x509.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cstdio>
#include <memory>
#include <stdexcept>

#include "ws_client.h"

namespace palpate::testing {
namespace {

template <typename T>
using Owned = std::unique_ptr<T, void (*)(T*)>;

void require(bool holds, const char* what) {
  if (!holds) throw std::runtime_error(what);
}

Owned<X509> selfSigned(EVP_PKEY* key) {
  Owned<X509> x509(X509_new(), &X509_free);
  X509_gmtime_adj(X509_getm_notBefore(x509.get()), -3600);
  X509_gmtime_adj(X509_getm_notAfter(x509.get()), 3600);
  X509_set_pubkey(x509.get(), key);
  X509_NAME* name = X509_get_subject_name(x509.get());
  const auto* host = reinterpret_cast<const unsigned char*>("localhost");
  X509_NAME_add_entry_by_txt(name, "CN", MBSTRING_ASC, host, -1, -1, 0);
  X509_set_issuer_name(x509.get(), name);
  require(X509_sign(x509.get(), key, EVP_sha256()) > 0, "no signature");
  return x509;
}

Owned<std::FILE> opened(const std::string& path) {
  Owned<std::FILE> file(std::fopen(path.c_str(), "w"), [](std::FILE* f) { std::fclose(f); });
  require(file != nullptr, "no file for a certificate");
  return file;
}

std::string readAll(SSL* tls, std::size_t enough) {
  std::string answer;
  char chunk[4096];
  for (int n = 0; answer.size() < enough && (n = SSL_read(tls, chunk, sizeof chunk)) > 0;)
    answer.append(chunk, static_cast<std::size_t>(n));
  return answer;
}

}  // namespace

TestCertificate::TestCertificate(const std::string& password) {
  const Owned<EVP_PKEY> key(EVP_EC_gen("P-256"), &EVP_PKEY_free);
  require(key != nullptr, "no key");
  const auto x509 = selfSigned(key.get());
  const auto cert_file = opened(certificate());
  const auto key_file = opened(this->key());
  const EVP_CIPHER* cipher = password.empty() ? nullptr : EVP_aes_128_cbc();
  require(PEM_write_X509(cert_file.get(), x509.get()) == 1, "no certificate");
  require(PEM_write_PKCS8PrivateKey(key_file.get(), key.get(), cipher, password.data(),
                                    static_cast<int>(password.size()), nullptr, nullptr) == 1,
          "no key file");
}

std::string tlsExchange(std::uint16_t port, const std::string& request, int newest, std::size_t enough) {
  const Owned<SSL_CTX> context(SSL_CTX_new(TLS_client_method()), &SSL_CTX_free);
  SSL_CTX_set_security_level(context.get(), 0);  // offers what old clients would
  SSL_CTX_set_min_proto_version(context.get(), TLS1_VERSION);
  SSL_CTX_set_max_proto_version(context.get(), newest);
  const Owned<SSL> tls(SSL_new(context.get()), &SSL_free);
  const int fd = connectTo(port);
  const timeval second{1, 0};
  setsockopt(fd, SOL_SOCKET, SO_RCVTIMEO, &second, sizeof second);
  SSL_set_fd(tls.get(), fd);
  std::string answer;
  if (SSL_connect(tls.get()) == 1 &&
      SSL_write(tls.get(), request.data(), static_cast<int>(request.size())) > 0)
    answer = readAll(tls.get(), enough);
  close(fd);
  return answer;
}

}  // namespace palpate::testing
