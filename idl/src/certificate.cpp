// SPDX-License-Identifier: Apache-2.0
#include "palpate/idl/certificate.h"

#include <openssl/bio.h>
#include <openssl/err.h>
#include <openssl/pem.h>
#include <openssl/pkcs7.h>

#include <array>
#include <cerrno>
#include <cstring>

#include "palpate/idl/error.h"

namespace palpate::dds {
namespace {

using BioPtr = std::unique_ptr<BIO, Freed<BIO_free_all>>;
using Pkcs7Ptr = std::unique_ptr<PKCS7, Freed<PKCS7_free>>;
struct StackFreed {
  void operator()(STACK_OF(X509) * stack) const noexcept { sk_X509_pop_free(stack, X509_free); }
};
using StackPtr = std::unique_ptr<STACK_OF(X509), StackFreed>;

BioPtr opened(const std::filesystem::path& file) {
  ERR_clear_error();
  errno = 0;
  BioPtr bio(BIO_new_file(file.c_str(), "rb"));
  if (!bio) throw DdsError(file.string() + ": cannot be read: " + std::strerror(errno));
  return bio;
}

std::string opensslReason() {
  const char* const reason = ERR_reason_error_string(ERR_peek_last_error());
  return reason == nullptr ? "" : std::string(" (") + reason + ")";
}

std::string contentOf(BIO* bio) {
  std::string text;
  std::array<char, 4096> part{};
  for (int size = 0; (size = BIO_read(bio, part.data(), part.size())) > 0;)
    text.append(part.data(), static_cast<std::size_t>(size));
  return text;
}

// A password that nobody is there to type.
int noPassword(char*, int, int, void*) {
  return -1;
}

std::time_t timeOfAsn1(const ASN1_TIME* asn1) {
  std::tm parts{};
  if (ASN1_TIME_to_tm(asn1, &parts) != 1) return 0;
  return timegm(&parts);
}

}  // namespace

X509Ptr readCertificate(const std::filesystem::path& file) {
  const BioPtr bio = opened(file);
  X509Ptr certificate(PEM_read_bio_X509(bio.get(), nullptr, nullptr, nullptr));
  if (!certificate) throw DdsError(file.string() + ": not a certificate in PEM form" + opensslReason());
  return certificate;
}

KeyPtr readKey(const std::filesystem::path& file) {
  const BioPtr bio = opened(file);
  KeyPtr key(PEM_read_bio_PrivateKey(bio.get(), nullptr, &noPassword, nullptr));
  if (!key)
    throw DdsError(file.string() + ": not a private key in PEM form without a password" + opensslReason());
  return key;
}

std::string readSigned(const std::filesystem::path& file, const X509& signer) {
  const BioPtr bio = opened(file);
  BIO* detached = nullptr;
  const Pkcs7Ptr message(SMIME_read_PKCS7(bio.get(), &detached));
  const BioPtr content(detached);
  if (!message) throw DdsError(file.string() + ": not a signed document (S/MIME)" + opensslReason());
  const StackPtr signers(sk_X509_new_null());
  sk_X509_push(signers.get(), X509_dup(&signer));
  const BioPtr out(BIO_new(BIO_s_mem()));
  constexpr int kFlags = PKCS7_TEXT | PKCS7_NOINTERN | PKCS7_NOVERIFY;
  if (PKCS7_verify(message.get(), signers.get(), nullptr, content.get(), out.get(), kFlags) != 1)
    throw DdsError(file.string() +
                   ": not signed by the authority of permissions_authority.pem beside it, or changed since" +
                   opensslReason());
  return contentOf(out.get());
}

std::string subjectOf(const X509& certificate) {
  const BioPtr bio(BIO_new(BIO_s_mem()));
  X509_NAME_print_ex(bio.get(), X509_get_subject_name(&certificate), 0, XN_FLAG_RFC2253);
  return contentOf(bio.get());
}

std::string fieldOf(const X509& certificate, int nid) {
  std::array<char, 256> text{};
  const int size =
      X509_NAME_get_text_by_NID(X509_get_subject_name(&certificate), nid, text.data(), text.size());
  return size <= 0 ? std::string() : std::string(text.data());
}

std::time_t startOf(const X509& certificate) {
  return timeOfAsn1(X509_get0_notBefore(&certificate));
}

std::time_t endOf(const X509& certificate) {
  return timeOfAsn1(X509_get0_notAfter(&certificate));
}

std::string utcOf(std::time_t time) {
  std::tm parts{};
  gmtime_r(&time, &parts);
  std::array<char, 32> text{};
  std::strftime(text.data(), text.size(), "%Y-%m-%dT%H:%M:%SZ", &parts);
  return text.data();
}

std::time_t timeOf(const std::string& utc) {
  std::tm parts{};
  const char* const end = strptime(utc.c_str(), "%Y-%m-%dT%H:%M:%SZ", &parts);
  if (end == nullptr || *end != '\0')
    throw DdsError("'" + utc + "' is not a time of the form 2027-03-01T12:00:00Z");
  return timegm(&parts);
}

}  // namespace palpate::dds
