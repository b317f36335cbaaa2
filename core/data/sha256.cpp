// SPDX-License-Identifier: Apache-2.0
// The one file of core that knows OpenSSL.
#include "core/data/sha256.h"

#include <openssl/evp.h>

#include <stdexcept>

namespace palpate {

namespace {

EVP_MD_CTX* contextOf(void* context) {
  return static_cast<EVP_MD_CTX*>(context);
}

void require(int good) {
  if (good != 1) throw std::runtime_error("OpenSSL cannot compute a SHA-256");
}

}  // namespace

void Sha256::Free::operator()(void* context) const noexcept {
  EVP_MD_CTX_free(contextOf(context));
}

Sha256::Sha256() : context_(EVP_MD_CTX_new()) {
  require(context_ != nullptr && EVP_DigestInit_ex(contextOf(context_.get()), EVP_sha256(), nullptr) == 1);
}

void Sha256::add(std::span<const std::byte> bytes) {
  require(EVP_DigestUpdate(contextOf(context_.get()), bytes.data(), bytes.size()));
}

Digest Sha256::finish() {
  Digest digest;
  require(EVP_DigestFinal_ex(contextOf(context_.get()), digest.bytes.data(), nullptr));
  return digest;
}

}  // namespace palpate
