// SPDX-License-Identifier: Apache-2.0
#include "tools/examine/certify/report/data_uri.h"

#include <openssl/evp.h>

#include <vector>

namespace palpate::certify {

std::string dataUri(const std::string& type, const std::string& content) {
  std::vector<unsigned char> encoded(4 * ((content.size() + 2) / 3) + 1);
  const int length = EVP_EncodeBlock(encoded.data(), reinterpret_cast<const unsigned char*>(content.data()),
                                     static_cast<int>(content.size()));
  return "data:" + type + ";base64," + std::string(encoded.begin(), encoded.begin() + length);
}

}  // namespace palpate::certify
