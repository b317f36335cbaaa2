// SPDX-License-Identifier: Apache-2.0
#include "authority.h"

#include <fcntl.h>
#include <openssl/bio.h>
#include <openssl/err.h>
#include <openssl/pem.h>
#include <openssl/pkcs7.h>
#include <openssl/rand.h>
#include <openssl/x509v3.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <type_traits>

#include "palpate/idl/certificate.h"
#include "palpate/idl/error.h"
#include "palpate/idl/identity.h"
#include "palpate/idl/identity_check.h"
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
  bool failed = !result;
  if constexpr (std::is_integral_v<T>) failed = result <= 0;
  if (failed) throw SecurityError(std::string("OpenSSL: ") + ERR_error_string(ERR_get_error(), nullptr));
  return result;
}

// Only what is made here gets a mode: whoever made what is there chose its own.
void makeFolder(const fs::path& folder, mode_t mode) {
  std::error_code error;
  if (folder.has_parent_path()) fs::create_directories(folder.parent_path(), error);
  if (error || (mkdir(folder.c_str(), 0700) == 0 ? chmod(folder.c_str(), mode) != 0 : errno != EEXIST))
    throw SecurityError("cannot make folder " + folder.string() + ": " +
                        (error ? error.message() : std::strerror(errno)));
}

std::string contentOf(BIO* bio) {
  char* data = nullptr;
  const long size = BIO_get_mem_data(bio, &data);
  return {data, static_cast<std::size_t>(size)};
}

// Of that mode whatever the umask is, and never more open, not even before it is whole.
void writeFile(const fs::path& path, const std::string& content, mode_t mode) {
  program::FileBeside beside(path);
  const int fd = open(beside.path().c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0600);
  if (fd < 0) throw program::WriteError(path, std::strerror(errno));
  const bool whole = write(fd, content.data(), content.size()) == static_cast<ssize_t>(content.size()) &&
                     fchmod(fd, mode) == 0 && fsync(fd) == 0;
  const int error = errno;
  close(fd);
  if (!whole) throw program::WriteError(path, std::strerror(error));
  beside.takePlace();
}

void writeKey(const fs::path& path, EVP_PKEY* key) {
  const BioPtr bio(made(BIO_new(BIO_s_mem())));
  made(PEM_write_bio_PrivateKey(bio.get(), key, nullptr, nullptr, 0, nullptr, nullptr));
  writeFile(path, contentOf(bio.get()), 0600);
}

void writeCertificate(const fs::path& path, X509* certificate) {
  const BioPtr bio(made(BIO_new(BIO_s_mem())));
  made(PEM_write_bio_X509(bio.get(), certificate));
  writeFile(path, contentOf(bio.get()), 0644);
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
dds::X509Ptr newCertificate(const Use& use, EVP_PKEY* key, std::time_t end, X509* issuer,
                            EVP_PKEY* issuer_key, const std::string& unit, const std::string& name) {
  dds::X509Ptr certificate(made(X509_new()));
  made(X509_set_version(certificate.get(), X509_VERSION_3));
  std::uint64_t serial = 0;
  made(RAND_bytes(reinterpret_cast<unsigned char*>(&serial), sizeof serial));
  made(ASN1_INTEGER_set_uint64(X509_get_serialNumber(certificate.get()), serial >> 1U));
  made(ASN1_TIME_set(X509_getm_notBefore(certificate.get()), std::time(nullptr) - kHour));
  made(ASN1_TIME_set(X509_getm_notAfter(certificate.get()), end));
  made(X509_set_pubkey(certificate.get(), key));
  X509_NAME* const subject = X509_get_subject_name(certificate.get());
  addField(subject, "O", "palpate");
  addField(subject, "OU", unit);
  addField(subject, "CN", name);
  X509* const signer = issuer == nullptr ? certificate.get() : issuer;
  made(X509_set_issuer_name(certificate.get(), X509_get_subject_name(signer)));
  addExtension(certificate.get(), signer, NID_basic_constraints, use.constraints);
  addExtension(certificate.get(), signer, NID_key_usage, use.key);
  if (use.extended != nullptr) addExtension(certificate.get(), signer, NID_ext_key_usage, use.extended);
  addExtension(certificate.get(), signer, NID_subject_key_identifier, "hash");
  made(X509_sign(certificate.get(), issuer_key == nullptr ? key : issuer_key, EVP_sha256()));
  return certificate;
}

std::time_t endAfter(Days days) {
  return std::time(nullptr) + days.count * kDay;
}

// Authorities are told apart by it.
std::string newName() {
  std::uint32_t number = 0;
  made(RAND_bytes(reinterpret_cast<unsigned char*>(&number), sizeof number));
  return "authority-" + std::to_string(number);
}

void checkName(const std::string& name) {
  const bool good = !name.empty() && name.size() <= 63 &&
                    std::isalnum(static_cast<unsigned char>(name.front())) != 0 &&
                    std::all_of(name.begin(), name.end(), [](unsigned char c) {
                      return c < 128 && (std::isalnum(c) != 0 || c == '-' || c == '_' || c == '.');
                    });
  if (!good)
    throw SecurityError(
        "name is '" + name +
        "', expected up to 63 letters, digits, '-', '_' and '.', the first a letter or digit");
}

// An identity's folder while it is made, beside its place, which it takes whole. What did not take it is removed.
class FolderBeside {
 public:
  explicit FolderBeside(const fs::path& target)
      : target_(target), path_(beside("new")), before_(beside("before")) {
    makeFolder(path_, 0700);
  }
  ~FolderBeside() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  FolderBeside(const FolderBeside&) = delete;
  FolderBeside& operator=(const FolderBeside&) = delete;

  [[nodiscard]] const fs::path& path() const noexcept { return path_; }
  void takePlace() {
    std::error_code error;
    const bool replaces = fs::exists(target_);
    if (replaces) fs::rename(target_, before_, error);
    if (!error) fs::rename(path_, target_, error);
    if (error) throw program::WriteError(target_, error.message());
    if (replaces) fs::remove_all(before_, error);
    if (error) throw SecurityError("cannot remove " + before_.string() + ": " + error.message());
  }

 private:
  // No identity's name begins with a dot.
  [[nodiscard]] fs::path beside(const char* what) const {
    std::string name(1, '.');
    name.append(target_.filename().string()).append(1, '.').append(what);
    return target_.parent_path() / name.append(1, '-').append(std::to_string(getpid()));
  }

  fs::path target_, path_, before_;
};

}  // namespace

void makeAuthority(const fs::path& folder, Days days) {
  if (fs::exists(folder / file::kAuthority))
    throw SecurityError(folder.string() +
                        " holds an authority already: another one would make its identities useless; "
                        "name another --folder");
  makeFolder(folder, 0755);
  dds::checkFolder(folder, dds::Others::kRead);
  makeFolder(folder / kIssued, 0755);
  dds::checkFolder(folder / kIssued, dds::Others::kRead);
  makeFolder(folder / kPrivate, 0700);
  dds::checkFolder(folder / kPrivate, dds::Others::kNothing);
  const std::string name = newName();
  const std::time_t end = endAfter(days);
  const auto make = [&](const Use& use, const char* unit, const fs::path& key_file, const char* file) {
    const dds::KeyPtr key = newKey();
    const dds::X509Ptr certificate = newCertificate(use, key.get(), end, nullptr, nullptr, unit, name);
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
  writeFile(to, contentOf(out.get()), 0644);
}

std::time_t checkAuthority(const fs::path& folder) {
  dds::checkFolder(folder, dds::Others::kRead);
  std::error_code none;
  const bool with_keys = fs::exists(folder / kPrivate, none);
  if (with_keys) dds::checkFolder(folder / kPrivate, dds::Others::kNothing);
  const auto check = [&](const fs::path& file, const fs::path& key_file) {
    dds::checkFile(file, dds::Others::kRead);
    dds::X509Ptr certificate = dds::readCertificate(file);
    dds::checkTimes(file, dds::startOf(*certificate), dds::endOf(*certificate), dds::kAnotherAuthority);
    if (!with_keys) return certificate;
    dds::checkFile(key_file, dds::Others::kNothing);
    if (X509_check_private_key(certificate.get(), dds::readKey(key_file).get()) != 1)
      throw dds::DdsError(key_file.string() + ": not the key of " + file.string());
    return certificate;
  };
  const dds::X509Ptr authority = check(folder / file::kAuthority, folder / kPrivate / kAuthorityKey);
  const Signer signer = permissionsSigner(folder);
  const dds::X509Ptr permissions_authority = check(signer.certificate, signer.key);
  dds::checkFile(folder / file::kGovernance, dds::Others::kRead);
  (void)dds::readSigned(folder / file::kGovernance, *permissions_authority);
  return std::min(dds::endOf(*authority), dds::endOf(*permissions_authority));
}

Issued issue(const fs::path& folder, dds::Role role, const std::string& name, Days days, bool renew) {
  checkName(name);
  if (!fs::exists(folder / file::kAuthority))
    throw SecurityError(folder.string() + " holds no authority: palpate-security init --folder " +
                        folder.string() + " makes one");
  const std::time_t authority_end = checkAuthority(folder), wanted = endAfter(days);
  const std::time_t end = std::min(authority_end, wanted);
  const dds::X509Ptr authority = dds::readCertificate(folder / file::kAuthority);
  const dds::KeyPtr authority_key = dds::readKey(folder / kPrivate / kAuthorityKey);
  const fs::path target = folder / kIssued / name;
  if (fs::exists(target) && !renew)
    throw SecurityError(
        target.string() +
        " is there already: --renew replaces it; a copy of the present one holds until its own "
        "end");
  FolderBeside made_in(target);
  const dds::KeyPtr key = newKey();
  const dds::X509Ptr certificate = newCertificate(kIsIdentity, key.get(), end, authority.get(),
                                                  authority_key.get(), std::string(dds::wordOf(role)), name);
  writeKey(made_in.path() / file::kKey, key.get());
  writeCertificate(made_in.path() / file::kCertificate, certificate.get());
  writeSigned(permissionsSigner(folder),
              permissions(role, dds::subjectOf(*certificate), dds::utcOf(dds::startOf(*certificate)),
                          dds::utcOf(dds::endOf(*certificate))),
              made_in.path() / file::kPermissions);
  for (const char* shared : {file::kAuthority, file::kPermissionsAuthority, file::kGovernance}) {
    std::error_code error;
    fs::copy_file(folder / shared, made_in.path() / shared, error);
    if (error) throw program::WriteError(target / shared, error.message());
  }
  made_in.takePlace();
  return {target, end, end < wanted};
}

}  // namespace palpate::security
