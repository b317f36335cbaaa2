// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <cstring>
#include <filesystem>
#include <string>
#include <string_view>

namespace palpate::mesh {

/// Reads an untrusted mesh file, as text tokens or as binary numbers. Every read checks the end of the file;
/// errors are MeshError with the file's name and, in text, the line.
class ByteReader {
 public:
  /// Reads the whole file. @throw MeshError when it is missing, a directory, unreadable or empty.
  explicit ByteReader(const std::filesystem::path& path);
  /// Reads these bytes. @param[in] name  how the file is called in messages  @throw MeshError without any
  ByteReader(std::string name, std::string bytes);

  /// From now on binary numbers are in the other byte order.
  void swapBytes(bool swap) { swap_ = swap; }
  /// Whether integer64(), integer32() and real() read binary numbers from now on.
  void setBinary(bool binary) { binary_ = binary; }
  [[nodiscard]] bool binary() const { return binary_; }

  [[nodiscard]] std::string_view rest() const { return std::string_view(bytes_).substr(at_); }
  void skip(std::size_t bytes, const char* what);
  void skipSpace();
  [[nodiscard]] bool atEnd();  ///< only white space follows

  /// The next word. @throw MeshError at the end of the file.
  std::string_view word(const char* what);
  /// The rest of this line, without its end.
  std::string_view line();
  /// One text number, whatever the mode.
  std::int64_t textInteger(const char* what);
  double textReal(const char* what);

  /// A number in the current mode; binary: of this width.
  std::int64_t integer64(const char* what) { return binary_ ? raw<std::int64_t>(what) : textInteger(what); }
  std::int64_t integer32(const char* what) { return binary_ ? raw<std::int32_t>(what) : textInteger(what); }
  double real(const char* what) { return binary_ ? raw<double>(what) : textReal(what); }

  template <typename T>
  T raw(const char* what) {
    char bytes[sizeof(T)];
    need(sizeof(T), what);
    for (std::size_t i = 0; i < sizeof(T); ++i) bytes[swap_ ? sizeof(T) - 1 - i : i] = bytes_[at_ + i];
    at_ += sizeof(T);
    T value;
    std::memcpy(&value, bytes, sizeof(T));
    return value;
  }

  /// A count of items of at least `bytes_each` bytes that fit in the rest of the file, so allocating them is
  /// safe.
  std::size_t checkedCount(std::int64_t count, std::size_t bytes_each, const char* what) const;

  /// Throws the MeshError `file: message` (with the line, in text).
  [[noreturn]] void fail(const std::string& message) const;

 private:
  void need(std::size_t bytes, const char* what) const;

  std::string path_;
  std::string bytes_;
  std::size_t at_{0};
  bool swap_{false};
  bool binary_{false};
};

}  // namespace palpate::mesh
