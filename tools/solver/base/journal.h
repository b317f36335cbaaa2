// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <functional>
#include <limits>
#include <map>
#include <mutex>
#include <optional>
#include <span>
#include <vector>

#include "core/record/byte_stream.h"
#include "tools/solver/base/blocks.h"

namespace palpate::solver {

/// Which parts of a stage are done and what came of them, in a file to which each part is appended once it is done. Whoever
/// opens it again finds every part that was appended whole: the file ends at the first record whose checksum is wrong.
/// Threads: any number.                                                            docs/decisions/checkpoints.md
class Journal {
 public:
  /// @throw std::runtime_error naming the file
  explicit Journal(std::filesystem::path file);
  ~Journal();
  Journal(const Journal&) = delete;
  Journal& operator=(const Journal&) = delete;

  /// What was kept of a part; absent where it is to be done.
  [[nodiscard]] std::optional<record::Bytes> find(std::uint64_t part) const;
  /// @param seconds  of wall time that the part took  @throw std::runtime_error naming the file: the disk is full
  void keep(std::uint64_t part, const record::Bytes& result, double seconds);
  /// What was kept of a part holds, and is not done again.
  void taken(std::uint64_t part) const;
  /// Seconds that the parts taken so far had cost.
  [[nodiscard]] double found() const;

 private:
  struct Place {
    std::int64_t offset;
    std::size_t size;
    double seconds;
  };

  void readBack();
  [[noreturn]] void fail(const char* what) const;

  std::filesystem::path path_;
  int file_{-1};
  mutable std::mutex mutex_;
  std::map<std::uint64_t, Place> places_;
  mutable double found_{0.0};
};

/// An array that says how long it is.
template <class T>
void putArray(record::Bytes& out, const std::vector<T>& values) {
  record::put(out, static_cast<std::uint64_t>(values.size()));
  record::putBytes(out, values.data(), values.size() * sizeof(T));
}
/// @throw record::RecordError  it ends early
template <class T>
void getArray(record::ByteSource& in, std::vector<T>& values) {
  const auto count = in.get<std::uint64_t>();
  if (count > std::numeric_limits<std::uint32_t>::max()) throw record::RecordError("an array is too long");
  const std::span<const std::uint8_t> bytes = in.take(count * sizeof(T));
  values.resize(count);
  if (count > 0) std::memcpy(values.data(), bytes.data(), bytes.size());
}

/// The parts of a stage that a process does.
struct PartRange {
  std::size_t begin, end;
  PartRange(std::size_t count) : begin(0), end(count) {}
  PartRange(std::size_t from, std::size_t to) : begin(from), end(to) {}
};
/// Parts of `part` entries each, of which this rank's blocks are made.
[[nodiscard]] inline PartRange partsOf(const Blocks& blocks, std::size_t part) {
  return {(blocks.ownBegin() + part - 1) / part, (blocks.ownEnd() + part - 1) / part};
}

/// parallelFor() over the parts of a stage that no journal has.
/// @param journal  null: nothing is kept
/// @param restore  takes what was kept of a part; throws record::RecordError where it is damaged, and the part is done again.
///                 Called from several threads, as the next
/// @param work  does a part and says what is to be kept
void parallelParts(int workers, PartRange parts, Journal* journal,
                   const std::function<void(std::size_t part, record::ByteSource& kept)>& restore,
                   const std::function<record::Bytes(int worker, std::size_t part)>& work);

/// The only part of a stage, or one of a few that are done in turn: what was kept of it, or what compute() gives.
/// @param put  appends a result to bytes  @param get  takes it from a source; throws record::RecordError where it is damaged
template <class T, class Compute, class Put, class Get>
T keptOr(Journal* journal, std::uint64_t part, const Compute& compute, const Put& put, const Get& get) {
  if (const auto kept = journal == nullptr ? std::nullopt : journal->find(part)) try {
      record::ByteSource source(*kept);
      T result{};
      get(source, result);
      journal->taken(part);
      return result;
    } catch (const record::RecordError&) {  // it is done again
    }
  const auto start = std::chrono::steady_clock::now();
  T result = compute();
  if (journal == nullptr) return result;
  record::Bytes bytes;
  put(bytes, result);
  journal->keep(part, bytes, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  return result;
}

/// keptOr() of what all ranks compute together: the first rank keeps it.
template <class T, class Compute, class Put, class Get>
T keptByFirstOr(const Ranks& ranks, Journal* journal, std::uint64_t part, const Compute& compute,
                const Put& put, const Get& get) {
  if (ranks.size() == 1) return keptOr<T>(journal, part, compute, put, get);
  Journal* const own = ranks.isFirst() ? journal : nullptr;
  record::Bytes kept = own == nullptr ? record::Bytes() : own->find(part).value_or(record::Bytes());
  std::uint64_t size = kept.size();
  ranks.broadcast(std::as_writable_bytes(std::span(&size, 1)), 0);
  kept.resize(size);
  ranks.broadcast(std::as_writable_bytes(std::span(kept)), 0);
  if (size > 0) try {
      record::ByteSource source(kept);
      T result{};
      get(source, result);
      if (own != nullptr) own->taken(part);
      return result;
    } catch (const record::RecordError&) {  // all do it again
    }
  const auto nothing = [](record::ByteSource&, T&) { throw record::RecordError("is done again"); };
  return keptOr<T>(own, part, compute, put, nothing);
}

}  // namespace palpate::solver
