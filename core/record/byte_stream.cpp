// SPDX-License-Identifier: Apache-2.0
#include "core/record/byte_stream.h"

namespace palpate::record {

void putBytes(Bytes& out, const void* from, std::size_t size) {
  const auto* bytes = static_cast<const std::uint8_t*>(from);
  out.insert(out.end(), bytes, bytes + size);
}

}  // namespace palpate::record
