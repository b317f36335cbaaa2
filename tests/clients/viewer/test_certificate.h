// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

#include "palpate/testing/files.h"

namespace palpate::testing {

/// A certificate for localhost that signed itself, and its key, in a folder of their own.
class TestCertificate {
 public:
  /// @param[in] password  of the key file; empty: none. @throw std::runtime_error  OpenSSL refuses
  explicit TestCertificate(const std::string& password = "");
  [[nodiscard]] std::string certificate() const { return folder_ / "cert.pem"; }
  [[nodiscard]] std::string key() const { return folder_ / "key.pem"; }

 private:
  TemporaryFolder folder_;
};

/// Sends a request over TLS to this machine, no matter who signed its certificate.
/// @param[in] newest  TLS version, e.g. 0x0303 for 1.2; 0: any
/// @return what comes within a second, until `enough` characters; empty when there is no handshake
[[nodiscard]] std::string tlsExchange(std::uint16_t port, const std::string& request, int newest = 0,
                                      std::size_t enough = 1U << 20);

}  // namespace palpate::testing
