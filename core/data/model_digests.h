// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/data/model_reader.h"
#include "core/data/sha256.h"

namespace palpate {

/// What the digests that a model states are compared with.
struct ModelDigests {
  Digest provenance, content, certificate;  ///< of the texts, and contentDigest()
};

/// In the order of the members. O(bytes).
[[nodiscard]] ModelDigests digestsOf(const ModelContents& contents);

}  // namespace palpate
