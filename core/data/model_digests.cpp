// SPDX-License-Identifier: Apache-2.0
#include "core/data/model_digests.h"

#include <span>
#include <string>

#include "core/data/model_content.h"

namespace palpate {

ModelDigests digestsOf(const ModelContents& contents) {
  const auto ofText = [](const std::string& text) {
    return sha256(std::as_bytes(std::span<const char>(text)));
  };
  ModelDigests digests;
  digests.provenance = ofText(contents.attributes.provenance);
  digests.content = contentDigest(contents.attributes, contents.view);
  digests.certificate = ofText(contents.attributes.certificate);
  return digests;
}

}  // namespace palpate
