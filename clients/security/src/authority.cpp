// SPDX-License-Identifier: Apache-2.0
#include "authority.h"

#include <fcntl.h>
#include <openssl/bio.h>
#include <openssl/err.h>
#include <openssl/pem.h>
#include <openssl/pkcs7.h>
#include <openssl/rand.h>
#include <openssl/x509v3.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <ctime>

#include "palpate/idl/certificate.h"
#include "palpate/idl/identity.h"
#include "tools/program/write_file.h"

namespace palpate::security {
namespace {

namespace fs = std::filesystem;
namespace file = dds::identity_file;
using BioPtr = std::unique_ptr<BIO, dds::Freed<BIO_free_all>>;

constexpr std::time_t kHour = 3600, kDay = 86400;

// OpenSSL fails here only when memory or randomness is out.
template <class T>
T made(T result) {
  if (!result) throw SecurityError(std::string("OpenSSL: ") + ERR_error_string(ERR_get_error(), nullptr));
  return result;
}

void makeFolder(const fs::path& folder, fs::perms mode) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (!error) fs::permissions(folder, mode, error);
  if (error) throw SecurityError("cannot make folder " + folder.string() + ": " + error.message());
}

std::string contentOf(BIO* bio) {
  char* data = nullptr;
  const long size = BIO_get_mem_data(bio, &data);
  return {data, static_cast<std::size_t>(size)};
}

// Nobody else can open it, not even before it is whole.
void writePrivate(const fs::path& path, const std::string& content) {
  program::FileBeside beside(path);
  const int fd = open(beside.path().c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0600);
  if (fd < 0) throw program::WriteError(path, std::strerror(errno));
  const bool whole =
      write(fd, content.data(), content.size()) == static_cast<ssize_t>(content.size()) && fsync(fd) == 0;
  const int error = errno;
  close(fd);
  if (!whole) throw program::WriteError(path, std::strerror(error));
  beside.takePlace();
}

void writeKey(const fs::path& path, EVP_PKEY* key) {
  const BioPtr bio(made(BIO_new(BIO_s_mem())));
  made(PEM_write_bio_PrivateKey(bio.get(), key, nullptr, nullptr, 0, nullptr, nullptr));
  writePrivate(path, contentOf(bio.get()));
}

void writeCertificate(const fs::path& path, X509* certificate) {
  const BioPtr bio(made(BIO_new(BIO_s_mem())));
  made(PEM_write_bio_X509(bio.get(), certificate));
  program::writeFile(path, contentOf(bio.get()));
}

dds::KeyPtr newKey() {
  return dds::KeyPtr(made(EVP_EC_gen("P-256")));
}

void addField(X509_NAME* name, const char* field, const std::string& value) {
  made(X509_NAME_add_entry_by_txt(name, field, MBSTRING_UTF8,
                                  reinterpret_cast<const unsigned char*>(value.c_str()), -1, -1, 0));
}

void addExtension(X509* certificate, X509* issuer, int nid, const char* value) {
  X509V3_CTX context;
  X509V3_set_ctx(&context, issuer, certificate, nullptr, nullptr, 0);
  const std::unique_ptr<X509_EXTENSION, dds::Freed<X509_EXTENSION_free>> extension(
      made(X509V3_EXT_conf_nid(nullptr, &context, nid, value)));
  made(X509_add_ext(certificate, extension.get(), -1));
}

// What a certificate is good for, as its extensions say. An identity's signs no documents: a second bar, behind
// permissions_authority.pem, to one that would write its own permissions.
struct Use {
  const char *constraints, *key, *extended;  // the last nullptr: whatever `key` allows
};
constexpr Use kSignsIdentities{"critical,CA:TRUE,pathlen:0", "critical,keyCertSign,cRLSign", nullptr};
constexpr Use kSignsDocuments{"critical,CA:FALSE", "critical,digitalSignature", "critical,emailProtection"};
constexpr Use kIsIdentity{"critical,CA:FALSE", "critical,digitalSignature,keyAgreement",
                          "critical,clientAuth"};

// Signed by whom it is issued by; without an issuer by itself.
dds::X509Ptr newCertificate(const Use& use, EVP_PKEY* key, Days days, X509* issuer, EVP_PKEY* issuer_key,
                            const std::string& unit, const std::string& name) {
  dds::X509Ptr certificate(made(X509_new()));
  X509_set_version(certificate.get(), X509_VERSION_3);
  std::uint64_t serial = 0;
  made(RAND_bytes(reinterpret_cast<unsigned char*>(&serial), sizeof serial));
  ASN1_INTEGER_set_uint64(X509_get_serialNumber(certificate.get()), serial >> 1U);
  const std::time_t now = std::time(nullptr);
  ASN1_TIME_set(X509_getm_notBefore(certificate.get()), now - kHour);
  ASN1_TIME_set(X509_getm_notAfter(certificate.get()), now + days.count * kDay);
  X509_set_pubkey(certificate.get(), key);
  X509_NAME* const subject = X509_get_subject_name(certificate.get());
  addField(subject, "O", "palpate");
  addField(subject, "OU", unit);
  addField(subject, "CN", name);
  X509* const signer = issuer == nullptr ? certificate.get() : issuer;
  X509_set_issuer_name(certificate.get(), X509_get_subject_name(signer));
  addExtension(certificate.get(), signer, NID_basic_constraints, use.constraints);
  addExtension(certificate.get(), signer, NID_key_usage, use.key);
  if (use.extended != nullptr) addExtension(certificate.get(), signer, NID_ext_key_usage, use.extended);
  addExtension(certificate.get(), signer, NID_subject_key_identifier, "hash");
  made(X509_sign(certificate.get(), issuer_key == nullptr ? key : issuer_key, EVP_sha256()));
  return certificate;
}

// Authorities are told apart by it.
std::string newName() {
  std::uint32_t number = 0;
  made(RAND_bytes(reinterpret_cast<unsigned char*>(&number), sizeof number));
  return "authority-" + std::to_string(number);
}

void checkName(const std::string& name) {
  const bool good = !name.empty() && name.size() <= 63 && name.front() != '.' && name.front() != '-' &&
                    std::all_of(name.begin(), name.end(), [](unsigned char c) {
                      return c < 128 && (std::isalnum(c) != 0 || c == '-' || c == '_' || c == '.');
                    });
  if (!good)
    throw SecurityError(
        "name is '" + name +
        "', expected up to 63 letters, digits, '-', '_' and '.', the first a letter or digit");
}

constexpr fs::perms kOwnersOnly = fs::perms::owner_all;
constexpr fs::perms kReadable = fs::perms::owner_all | fs::perms::group_read | fs::perms::group_exec |
                                fs::perms::others_read | fs::perms::others_exec;

}  // namespace

void makeAuthority(const fs::path& folder, Days days) {
  if (fs::exists(folder / file::kAuthority))
    throw SecurityError(folder.string() +
                        " holds an authority already: another one would make its identities useless; "
                        "name another --folder");
  makeFolder(folder, kReadable);
  makeFolder(folder / kIssued, kReadable);
  makeFolder(folder / kPrivate, kOwnersOnly);
  const std::string name = newName();
  const auto make = [&](const Use& use, const char* unit, const fs::path& key_file, const char* file) {
    const dds::KeyPtr key = newKey();
    const dds::X509Ptr certificate = newCertificate(use, key.get(), days, nullptr, nullptr, unit, name);
    writeKey(folder / kPrivate / key_file, key.get());
    writeCertificate(folder / file, certificate.get());
  };
  make(kSignsDocuments, "permissions", kPermissionsKey, file::kPermissionsAuthority);
  writeSigned(permissionsSigner(folder), governance(), folder / file::kGovernance);
  // Last: it says that the authority is there.
  make(kSignsIdentities, "authority", kAuthorityKey, file::kAuthority);
}

Signer permissionsSigner(const fs::path& authority) {
  return {authority / file::kPermissionsAuthority, authority / kPrivate / kPermissionsKey};
}

void writeSigned(const Signer& signer, const std::string& document, const fs::path& to) {
  const dds::X509Ptr certificate = dds::readCertificate(signer.certificate);
  const dds::KeyPtr key = dds::readKey(signer.key);
  const BioPtr in(made(BIO_new_mem_buf(document.data(), static_cast<int>(document.size()))));
  const BioPtr out(made(BIO_new(BIO_s_mem())));
  constexpr int kFlags = PKCS7_TEXT | PKCS7_DETACHED;
  const std::unique_ptr<PKCS7, dds::Freed<PKCS7_free>> message(
      made(PKCS7_sign(certificate.get(), key.get(), nullptr, in.get(), kFlags)));
  BIO_reset(in.get());
  made(SMIME_write_PKCS7(out.get(), message.get(), in.get(), kFlags));
  program::writeFile(to, contentOf(out.get()));
}

fs::path issue(const fs::path& folder, dds::Role role, const std::string& name, Days days, bool renew) {
  checkName(name);
  if (!fs::exists(folder / file::kAuthority))
    throw SecurityError(folder.string() + " holds no authority: palpate-security init --folder " +
                        folder.string() + " makes one");
  const dds::X509Ptr authority = dds::readCertificate(folder / file::kAuthority);
  const dds::KeyPtr authority_key = dds::readKey(folder / kPrivate / kAuthorityKey);
  fs::path made_in = folder / kIssued / name;
  if (fs::exists(made_in) && !renew)
    throw SecurityError(
        made_in.string() +
        " is there already: --renew replaces it; a copy of the present one holds until its own end");
  makeFolder(made_in, kOwnersOnly);
  const dds::KeyPtr key = newKey();
  const dds::X509Ptr certificate = newCertificate(kIsIdentity, key.get(), days, authority.get(),
                                                  authority_key.get(), std::string(dds::wordOf(role)), name);
  writeKey(made_in / file::kKey, key.get());
  writeCertificate(made_in / file::kCertificate, certificate.get());
  writeSigned(permissionsSigner(folder),
              permissions(role, dds::subjectOf(*certificate), dds::utcOf(dds::startOf(*certificate)),
                          dds::utcOf(dds::endOf(*certificate))),
              made_in / file::kPermissions);
  for (const char* shared : {file::kAuthority, file::kPermissionsAuthority, file::kGovernance}) {
    std::error_code error;
    fs::copy_file(folder / shared, made_in / shared, fs::copy_options::overwrite_existing, error);
    if (error) throw SecurityError("cannot write " + (made_in / shared).string() + ": " + error.message());
  }
  return made_in;
}

}  // namespace palpate::security
