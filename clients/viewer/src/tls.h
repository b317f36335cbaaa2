// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace palpate::viewer {

/// Files in PEM; both empty: plain http.
struct TlsFiles {
  std::string certificate;  ///< the server's, then those that signed it
  std::string key;          ///< without a password
  [[nodiscard]] bool given() const noexcept { return !certificate.empty(); }
};

/// Looks at the files before a port is opened.
/// @throw client::ClientError  only one is given, one cannot be read, or the key is not the certificate's; names the file
void check(const TlsFiles& files);

}  // namespace palpate::viewer
