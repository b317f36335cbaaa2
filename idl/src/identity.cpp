// SPDX-License-Identifier: Apache-2.0
#include "palpate/idl/identity.h"

#include <dlfcn.h>
#include <openssl/objects.h>

#include <algorithm>

#include "palpate/idl/certificate.h"
#include "palpate/idl/error.h"
#include "palpate/idl/identity_check.h"

namespace palpate::dds {
namespace {

namespace fs = std::filesystem;
namespace file = identity_file;

constexpr std::time_t kDay = 86400;
constexpr std::time_t kWarnBefore = 30 * kDay;

void checkFiles(const fs::path& folder) {
  checkFolder(folder, Others::kRead);
  std::error_code none;
  if (!fs::exists(folder / file::kCertificate, none) && fs::exists(folder / "issued", none))
    throw DdsError(folder.string() + ": the folder of an authority, expected one that it issued, e.g. " +
                   (folder / "issued" / "NAME").string());
  for (const char* name : {file::kAuthority, file::kPermissionsAuthority, file::kGovernance,
                           file::kCertificate, file::kPermissions})
    checkFile(folder / name, Others::kRead);
  checkFile(folder / file::kKey, Others::kNothing);
}

constexpr const char* kRenew = "palpate-security issue --renew makes a new one";

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
  checkTimes(path, timeOf(between(path, text, "not_before")), end, kRenew);
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
  checkTimes(authority_file, startOf(*authority), endOf(*authority), kAnotherAuthority);
  checkTimes(signer_file, startOf(*signer), endOf(*signer), kAnotherAuthority);
  if (X509_verify(certificate.get(), X509_get0_pubkey(authority.get())) != 1)
    throw DdsError(certificate_file.string() + ": not signed by the authority of authority.pem beside it");
  checkTimes(certificate_file, startOf(*certificate), endOf(*certificate), kRenew);
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
  const std::time_t authorities_end = std::min(endOf(*authority), endOf(*signer));
  identity.expires_ = std::min({authorities_end, endOf(*certificate), permitted});
  identity.remedy_ =
      identity.expires_ == authorities_end
          ? std::string("its authority ends then: ") + kAnotherAuthority
          : "palpate-security issue --renew " + word + " " + identity.name_ + " makes a new one";
  return identity;
}

std::string Identity::warning(std::time_t now) const {
  if (expires_ - now >= kWarnBefore) return {};
  return folder_.string() + ": expires on " + utcOf(expires_) + ", in " +
         std::to_string((expires_ - now) / kDay) + " days; " + remedy_;
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
