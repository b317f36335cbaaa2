// SPDX-License-Identifier: Apache-2.0
#include "palpate/idl/identity.h"

#include <dlfcn.h>
#include <openssl/objects.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>

#include "palpate/idl/certificate.h"
#include "palpate/idl/error.h"

namespace palpate::dds {
namespace {

namespace fs = std::filesystem;
namespace file = identity_file;

constexpr std::time_t kDay = 86400;
constexpr std::time_t kWarnBefore = 30 * kDay;

std::string octal(mode_t mode) {
  std::array<char, 8> text{};
  std::snprintf(text.data(), text.size(), "%04o", mode & 07777U);
  return text.data();
}

// Others who can write a file here could take the authority's place.
void checkMode(const fs::path& path, mode_t forbidden, const char* expected) {
  struct stat status {};
  if (stat(path.c_str(), &status) != 0) throw DdsError(path.string() + ": " + std::strerror(errno));
  if (!S_ISREG(status.st_mode)) throw DdsError(path.string() + ": not a file");
  if (status.st_uid != geteuid() && status.st_uid != 0)
    throw DdsError(path.string() + ": belongs to user " + std::to_string(status.st_uid) +
                   ", expected the user who runs this program, or root; chown it");
  if ((status.st_mode & forbidden) != 0)
    throw DdsError(path.string() + ": mode is " + octal(status.st_mode) + ", others may " +
                   ((forbidden & S_IRGRP) != 0 ? "read" : "write") + " it; chmod " + expected + " " +
                   path.string());
}

void checkFiles(const fs::path& folder) {
  if (!fs::is_directory(folder)) throw DdsError(folder.string() + ": no such folder");
  if (!fs::exists(folder / file::kCertificate) && fs::exists(folder / "issued"))
    throw DdsError(folder.string() + ": the folder of an authority, expected one that it issued, e.g. " +
                   (folder / "issued" / "NAME").string());
  for (const char* name : {file::kAuthority, file::kPermissionsAuthority, file::kGovernance,
                           file::kCertificate, file::kPermissions})
    checkMode(folder / name, S_IWGRP | S_IWOTH, "go-w");
  checkMode(folder / file::kKey, S_IRWXG | S_IRWXO, "600");
}

// A file, and the days in which it is valid.
void checkTimes(const fs::path& path, std::time_t start, std::time_t end) {
  const std::time_t now = std::time(nullptr);
  if (now < start)
    throw DdsError(path.string() + ": valid from " + utcOf(start) + " on; is the clock right?");
  if (now >= end)
    throw DdsError(path.string() + ": expired on " + utcOf(end) +
                   "; palpate-security issue --renew makes a new one");
}

std::string between(const fs::path& path, const std::string& text, const std::string& tag) {
  const std::string open = "<" + tag + ">", close = "</" + tag + ">";
  const std::size_t start = text.find(open), end = text.find(close);
  if (start == std::string::npos || end == std::string::npos || end < start)
    throw DdsError(path.string() + ": " + tag + " is missing");
  return text.substr(start + open.size(), end - start - open.size());
}

// @return when they end
std::time_t checkPermissions(const fs::path& path, const X509& signer, const std::string& subject) {
  const std::string text = readSigned(path, signer);
  const std::string named = between(path, text, "subject_name");
  if (named != subject)
    throw DdsError(path.string() + ": subject_name is " + named + ", the certificate beside it is of " +
                   subject);
  const std::time_t end = timeOf(between(path, text, "not_after"));
  checkTimes(path, timeOf(between(path, text, "not_before")), end);
  return end;
}

// Debian keeps the plugins in a folder beside the library, others beside it.
fs::path plugin(const std::string& name) {
  Dl_info library{};
  const void* const inside = dlsym(RTLD_DEFAULT, "dds_create_participant");
  if (inside == nullptr || dladdr(inside, &library) == 0 || library.dli_fname == nullptr)
    throw DdsError("cannot tell where Cyclone DDS is installed");
  const fs::path beside = fs::path(library.dli_fname).parent_path();
  const std::string wanted = "libdds_security_" + name + ".so";
  for (const fs::path& folder : {beside / "libddsc0debian", beside})
    if (fs::exists(folder / wanted)) return folder / wanted;
  throw DdsError("this Cyclone DDS has no security plugins: " + wanted + " is neither in " +
                 (beside / "libddsc0debian").string() + " nor in " + beside.string() +
                 " (Debian: package libddsc0debian)");
}

}  // namespace

Identity Identity::load(const fs::path& folder) {
  checkFiles(folder);
  const fs::path authority_file = folder / file::kAuthority,
                 signer_file = folder / file::kPermissionsAuthority,
                 certificate_file = folder / file::kCertificate;
  const X509Ptr authority = readCertificate(authority_file), signer = readCertificate(signer_file),
                certificate = readCertificate(certificate_file);
  checkTimes(authority_file, startOf(*authority), endOf(*authority));
  checkTimes(signer_file, startOf(*signer), endOf(*signer));
  if (X509_verify(certificate.get(), X509_get0_pubkey(authority.get())) != 1)
    throw DdsError(certificate_file.string() + ": not signed by the authority of authority.pem beside it");
  checkTimes(certificate_file, startOf(*certificate), endOf(*certificate));
  const KeyPtr key = readKey(folder / file::kKey);
  if (X509_check_private_key(certificate.get(), key.get()) != 1)
    throw DdsError((folder / file::kKey).string() + ": not the key of identity.pem beside it");
  (void)readSigned(folder / file::kGovernance, *signer);

  Identity identity;
  identity.folder_ = fs::absolute(folder);
  const std::string word = fieldOf(*certificate, NID_organizationalUnitName);
  const std::optional<Role> role = roleOf(word);
  if (!role)
    throw DdsError(certificate_file.string() + ": OU is '" + word + "', expected " +
                   wordsOf({Role::kServer, Role::kDriver, Role::kViewer, Role::kOperator}));
  identity.role_ = *role;
  identity.name_ = fieldOf(*certificate, NID_commonName);
  const std::time_t permitted =
      checkPermissions(folder / file::kPermissions, *signer, subjectOf(*certificate));
  identity.expires_ = std::min({endOf(*authority), endOf(*signer), endOf(*certificate), permitted});
  return identity;
}

std::string Identity::warning(std::time_t now) const {
  if (expires_ - now >= kWarnBefore) return {};
  return folder_.string() + ": expires on " + utcOf(expires_) + ", in " +
         std::to_string((expires_ - now) / kDay) + " days; palpate-security issue --renew " +
         std::string(wordOf(role_)) + " " + name_ + " makes a new one";
}

void Identity::applyTo(dds_qos_t& qos) const {
  struct Plugin {
    const char *key, *library, *word;
  };
  for (const Plugin& one : {Plugin{"auth", "auth", "authentication"},
                            Plugin{"access", "ac", "access_control"}, Plugin{"crypto", "crypto", "crypto"}}) {
    const std::string key = std::string("dds.sec.") + one.key + ".library.";
    dds_qset_prop(&qos, (key + "path").c_str(), plugin(one.library).c_str());
    dds_qset_prop(&qos, (key + "init").c_str(), (std::string("init_") + one.word).c_str());
    dds_qset_prop(&qos, (key + "finalize").c_str(), (std::string("finalize_") + one.word).c_str());
  }
  const auto set = [&](const char* key, const char* name) {
    dds_qset_prop(&qos, key, ("file:" + (folder_ / name).string()).c_str());
  };
  set("dds.sec.auth.identity_ca", file::kAuthority);
  set("dds.sec.auth.identity_certificate", file::kCertificate);
  set("dds.sec.auth.private_key", file::kKey);
  // Another one than identity_ca: Cyclone DDS 0.10.2 takes what anybody has signed whose certificate permissions_ca signed
  // (CVE-2023-24011), so identity_ca would let each identity write its own permissions.
  set("dds.sec.access.permissions_ca", file::kPermissionsAuthority);
  set("dds.sec.access.governance", file::kGovernance);
  set("dds.sec.access.permissions", file::kPermissions);
}

bool hasIdentity(dds_entity_t participant) {
  const QosPtr qos(dds_create_qos());
  char* value = nullptr;
  if (dds_get_qos(participant, qos.get()) != DDS_RETCODE_OK ||
      !dds_qget_prop(qos.get(), "dds.sec.auth.identity_certificate", &value))
    return false;
  dds_free(value);
  return true;
}

std::optional<Identity> identityFor(std::initializer_list<Role> roles, const fs::path& folder) {
  if (folder.empty()) return std::nullopt;
  Identity identity = Identity::load(folder);
  if (std::find(roles.begin(), roles.end(), identity.role()) == roles.end())
    throw DdsError(folder.string() + ": " + identity.name() + " has the role " +
                   std::string(wordOf(identity.role())) + ", this program needs " + wordsOf(roles));
  return identity;
}

}  // namespace palpate::dds
