// SPDX-License-Identifier: Apache-2.0
// What this process allocates in C++ from 64 KiB on are nearly all tables of models, made and freed by the thread that loads them. They
// get mappings of their own, which go back to the system as they came; in malloc's heap each exchange of organs would leave
// other holes (docs/decisions/memory_locking.md). DDS, in C, takes its buffers from malloc, and maps nothing for them. Not a source of the
// server's parts: it is for the process as a whole.
#include <sys/mman.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <mutex>
#include <new>
#include <utility>

namespace palpate::server {
namespace {

constexpr std::size_t kApart = std::size_t{64} * 1024;  // bytes
constexpr std::size_t kPage = 4096;
constexpr std::size_t kMost = 1024;  // a model has some hundred; what comes on top is malloc's

// Every address that is no multiple of a page is malloc's, and needs no look.
class Mappings {
 public:
  // @return null: there is no room, here or in memory
  void* add(std::size_t bytes) noexcept {
    void* const begin = mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (begin == MAP_FAILED) return nullptr;
    {
      const std::lock_guard lock(mutex_);
      if (count_ < kMost) {
        mappings_[count_++] = {begin, bytes};
        return begin;
      }
    }
    munmap(begin, bytes);
    return nullptr;
  }

  // @return false: it is not one of these
  bool remove(void* begin) noexcept {
    std::size_t bytes = 0;
    {
      const std::lock_guard lock(mutex_);
      const auto end = mappings_.begin() + static_cast<std::ptrdiff_t>(count_);
      const auto found =
          std::find_if(mappings_.begin(), end, [begin](const Mapping& m) { return m.begin == begin; });
      if (found == end) return false;
      bytes = found->bytes;
      *found = mappings_[--count_];
    }
    munmap(begin, bytes);
    return true;
  }

 private:
  struct Mapping {
    void* begin;
    std::size_t bytes;
  };
  std::mutex mutex_;
  std::array<Mapping, kMost> mappings_{};
  std::size_t count_{0};
};

constinit Mappings mappings;

bool isOfAPage(const void* memory) noexcept {
  return reinterpret_cast<std::uintptr_t>(memory) % kPage == 0;  // NOLINT: an address is asked about
}

void* fromMalloc(std::size_t bytes) {
  for (;;) {
    if (void* const memory = std::malloc(std::max(bytes, std::size_t{1}))) return memory;
    const std::new_handler handler = std::get_new_handler();
    if (handler == nullptr) throw std::bad_alloc();
    handler();
  }
}

}  // namespace
}  // namespace palpate::server

// All other forms of new and delete but the aligned ones end in these.
void* operator new(std::size_t bytes) {
  using namespace palpate::server;
  if (bytes >= kApart)
    if (void* const begin = mappings.add(bytes)) return begin;
  return fromMalloc(bytes);
}

void operator delete(void* memory) noexcept {
  using namespace palpate::server;
  if (memory == nullptr || (isOfAPage(memory) && mappings.remove(memory))) return;
  std::free(memory);
}

void operator delete(void* memory, std::size_t) noexcept {
  ::operator delete(memory);
}
