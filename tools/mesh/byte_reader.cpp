// SPDX-License-Identifier: Apache-2.0
#include "tools/mesh/byte_reader.h"

#include <algorithm>
#include <charconv>
#include <fstream>
#include <iterator>
#include <utility>

#include "tools/mesh/mesh_error.h"

namespace palpate::mesh {
namespace {

bool isSpace(char c) {
  return c == ' ' || c == '\n' || c == '\r' || c == '\t' || c == '\v' || c == '\f';
}

// For a message: at most 40 characters, without control characters.
std::string shown(std::string_view text) {
  std::string out;
  for (const char c : text.substr(0, 40)) out += c >= ' ' && c <= '~' ? c : '?';
  return text.size() > 40 ? out + "..." : out;
}

template <typename T>
bool parse(std::string_view word, T& value) {
  if (!word.empty() && word.front() == '+') word.remove_prefix(1);
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  return error == std::errc{} && end == word.data() + word.size();
}

std::string bytesOf(const std::filesystem::path& path) {
  const std::string name = path.string();
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (!std::filesystem::exists(status)) throw MeshError(name + ": no such file");
  if (!std::filesystem::is_regular_file(status)) throw MeshError(name + ": not a regular file");
  std::ifstream in(path, std::ios::binary);
  if (!in) throw MeshError(name + ": cannot be opened for reading");
  std::string bytes(std::istreambuf_iterator<char>(in), {});
  if (in.bad()) throw MeshError(name + ": cannot be read");
  return bytes;
}

}  // namespace

ByteReader::ByteReader(const std::filesystem::path& path) : ByteReader(path.string(), bytesOf(path)) {}

ByteReader::ByteReader(std::string name, std::string bytes)
    : path_(std::move(name)), bytes_(std::move(bytes)) {
  if (bytes_.empty()) throw MeshError(path_ + ": the file is empty");
}

void ByteReader::fail(const std::string& message) const {
  if (binary_) throw MeshError(path_ + ": " + message + " (byte " + std::to_string(at_) + ")");
  // The line end that was just read belongs to the wrong line.
  const auto read = static_cast<std::ptrdiff_t>(at_ > 0 && bytes_[at_ - 1] == '\n' ? at_ - 1 : at_);
  const auto lines = 1 + std::count(bytes_.begin(), bytes_.begin() + read, '\n');
  throw MeshError(path_ + ": line " + std::to_string(lines) + ": " + message);
}

void ByteReader::need(std::size_t bytes, const char* what) const {
  if (bytes_.size() - at_ < bytes) fail(std::string("the file ends in ") + what);
}

void ByteReader::skip(std::size_t bytes, const char* what) {
  need(bytes, what);
  at_ += bytes;
}

void ByteReader::skipSpace() {
  while (at_ < bytes_.size() && isSpace(bytes_[at_])) ++at_;
}

bool ByteReader::atEnd() {
  skipSpace();
  return at_ == bytes_.size();
}

std::string_view ByteReader::word(const char* what) {
  if (atEnd()) fail(std::string("the file ends where ") + what + " is expected");
  const std::size_t begin = at_;
  while (at_ < bytes_.size() && !isSpace(bytes_[at_])) ++at_;
  return std::string_view(bytes_).substr(begin, at_ - begin);
}

std::string_view ByteReader::line() {
  const std::size_t begin = at_;
  const std::size_t end = std::min(bytes_.find('\n', at_), bytes_.size());
  at_ = std::min(end + 1, bytes_.size());
  const std::string_view text = std::string_view(bytes_).substr(begin, end - begin);
  return !text.empty() && text.back() == '\r' ? text.substr(0, text.size() - 1) : text;
}

std::int64_t ByteReader::textInteger(const char* what) {
  const std::string_view text = word(what);
  std::int64_t value = 0;
  if (!parse(text, value)) fail(std::string(what) + " is '" + shown(text) + "', expected an integer");
  return value;
}

double ByteReader::textReal(const char* what) {
  const std::string_view text = word(what);
  double value = 0;
  if (!parse(text, value)) fail(std::string(what) + " is '" + shown(text) + "', expected a number");
  return value;
}

std::size_t ByteReader::checkedCount(std::int64_t count, std::size_t bytes_each, const char* what) const {
  const std::size_t left = bytes_.size() - at_;
  const std::size_t room = binary_ ? left : left + 1;  // no separator follows the last word of a text
  if (count < 0 || static_cast<std::uint64_t>(count) > room / bytes_each) {
    fail(std::string(what) + " is " + std::to_string(count) + ", but only " + std::to_string(left) +
         " bytes of the file are left");
  }
  return static_cast<std::size_t>(count);
}

}  // namespace palpate::mesh
