// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>

namespace palpate {

/// A SHA-256: nobody can make two contents with the same one.
struct Digest {
  std::array<std::uint8_t, 32> bytes{};

  /// 64 hexadecimal digits, lower case.
  [[nodiscard]] std::string hex() const;
  /// What names the content to people and on the wire: the first 40 digits of hex().
  [[nodiscard]] std::string id() const;
  /// The first 8 bytes, big endian: the number whose digits id() begins with.
  [[nodiscard]] std::uint64_t leading64() const noexcept;
  friend bool operator==(const Digest&, const Digest&) = default;
};

/// Computes a Digest piece by piece, by OpenSSL. @throw std::runtime_error  OpenSSL refuses
class Sha256 {
 public:
  /// Fewer bytes may be gone after add(); more have to stay until the digest is known, since a page hashes them later.
  static constexpr std::size_t kCopied = 4096;

  Sha256();
  void add(std::span<const std::byte> bytes);
  /// Once, at the end.
  [[nodiscard]] Digest finish();

 private:
  struct Free {
    void operator()(void* context) const noexcept;
  };
  std::unique_ptr<void, Free> context_;
};

[[nodiscard]] Digest sha256(std::span<const std::byte> bytes);

}  // namespace palpate
