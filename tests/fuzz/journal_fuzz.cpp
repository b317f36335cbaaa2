// SPDX-License-Identifier: Apache-2.0
#include <sys/mman.h>
#include <unistd.h>

#include <limits>

#include "core/record/crc32.h"
#include "targets.h"
#include "tools/solver/base/journal.h"

namespace palpate::fuzz {

namespace {

/// A file in memory that a path leads to.
class MemoryFile {
 public:
  MemoryFile() : file_(memfd_create("journal", MFD_CLOEXEC)) {
    require(file_ >= 0, "there are files in memory");
  }
  ~MemoryFile() { close(file_); }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;
  void fill(Bytes with) const {
    require(ftruncate(file_, 0) == 0 && pwrite(file_, with.data(), with.size(), 0) == std::ssize(with),
            "a file in memory takes bytes");
  }
  [[nodiscard]] std::string path() const { return "/proc/self/fd/" + std::to_string(file_); }

 private:
  int file_;
};

constexpr std::size_t kHead = 32, kSizeAt = 8,
                      kChecksumAt = 24;  // of a part: its number, size, seconds, checksum

}  // namespace

bool journal(Bytes input) {
  static const MemoryFile file;
  file.fill(input);
  constexpr std::uint64_t kNew = std::numeric_limits<std::uint64_t>::max();
  const record::Bytes kept{1, 2, 3};
  bool found = false;
  {
    solver::Journal first(file.path());
    for (std::uint64_t part = 0; part < 4; ++part) {
      const auto bytes = first.find(part);
      if (!bytes) continue;
      found = true;
      first.taken(part);
      try {
        record::ByteSource source(*bytes);
        std::vector<double> numbers;
        while (!source.empty()) solver::getArray(source, numbers);
      } catch (const record::RecordError&) {
      }
    }
    (void)first.found();
    first.keep(kNew, kept, 1.0);
  }
  const solver::Journal again(file.path());
  require(again.find(kNew) == kept, "what is appended behind damage is found again");
  return found;
}

void mendJournal(std::span<std::uint8_t> input) {
  while (input.size() >= kHead) {
    std::uint64_t size = 0;
    std::memcpy(&size, &input[kSizeAt], sizeof size);
    if (size > input.size() - kHead) {  // as long as it is
      size = input.size() - kHead;
      std::memcpy(&input[kSizeAt], &size, sizeof size);
    }
    std::memset(&input[kChecksumAt], 0, sizeof(std::uint32_t));
    const std::uint32_t checksum = record::crc32(input.first(kHead + size));
    std::memcpy(&input[kChecksumAt], &checksum, sizeof checksum);
    input = input.subspan(kHead + size);
  }
}

}  // namespace palpate::fuzz
