// SPDX-License-Identifier: Apache-2.0
// SHA-256 by the page: Module.sha256() gives an object with add(bytes) and finish(), which returns 32 bytes.
#include <emscripten.h>

#include <cstdint>

#include "core/data/sha256.h"

namespace palpate {

namespace {

// clang-format off
EM_JS(int, beginDigest, (), {
  Module.digests = Module.digests || [null];
  return Module.digests.push(Module.sha256()) - 1;
});
EM_JS(void, addToDigest, (int digest, const void* bytes, std::size_t size), {
  Module.digests[digest].add(HEAPU8.subarray(bytes, bytes + size));
});
EM_JS(void, finishDigest, (int digest, void* out), {
  HEAPU8.set(Module.digests[digest].finish(), out);
});
EM_JS(void, forgetDigest, (int digest), {
  Module.digests[digest] = null;
});
// clang-format on

int numberOf(const void* context) {
  return static_cast<int>(reinterpret_cast<std::intptr_t>(context));
}

}  // namespace

void Sha256::Free::operator()(void* context) const noexcept {
  forgetDigest(numberOf(context));
}

Sha256::Sha256() : context_(reinterpret_cast<void*>(std::intptr_t{beginDigest()})) {}

void Sha256::add(std::span<const std::byte> bytes) {
  addToDigest(numberOf(context_.get()), bytes.data(), bytes.size());
}

Digest Sha256::finish() {
  Digest digest;
  finishDigest(numberOf(context_.get()), digest.bytes.data());
  return digest;
}

}  // namespace palpate
