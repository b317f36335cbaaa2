// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <openssl/evp.h>
#include <openssl/x509.h>

#include <ctime>
#include <filesystem>
#include <memory>
#include <string>

namespace palpate::dds {

/// OpenSSL's objects, freed.
template <auto kFree>
struct Freed {
  template <class T>
  void operator()(T* object) const noexcept {
    kFree(object);
  }
};
using X509Ptr = std::unique_ptr<X509, Freed<X509_free>>;
using KeyPtr = std::unique_ptr<EVP_PKEY, Freed<EVP_PKEY_free>>;

/// PEM files. @throw DdsError naming the file and what is wrong with it
[[nodiscard]] X509Ptr readCertificate(const std::filesystem::path& file);
/// A key without a password.
[[nodiscard]] KeyPtr readKey(const std::filesystem::path& file);

/// The content of a file that `signer` itself signed (S/MIME), and nobody whom it certified: certificates in the file count
/// for nothing, nor do validity and use of the signer's. @throw DdsError  it did not, or not this content
[[nodiscard]] std::string readSigned(const std::filesystem::path& file, const X509& signer);

/// "CN=desk,OU=server,O=palpate", as permissions name it (RFC 2253).
[[nodiscard]] std::string subjectOf(const X509& certificate);
/// One field of it, e.g. NID_commonName; empty when it has none.
[[nodiscard]] std::string fieldOf(const X509& certificate, int nid);
[[nodiscard]] std::time_t startOf(const X509& certificate);
[[nodiscard]] std::time_t endOf(const X509& certificate);

/// "2027-03-01T12:00:00Z", as permissions have it, and back. @throw DdsError  not of that form
[[nodiscard]] std::string utcOf(std::time_t time);
[[nodiscard]] std::time_t timeOf(const std::string& utc);

}  // namespace palpate::dds
