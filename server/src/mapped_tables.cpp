// SPDX-License-Identifier: Apache-2.0
// What this process allocates in C++ from 64 KiB on are nearly all tables of models, made and freed by the thread that
// loads them. They get mappings of their own, which go back to the system as they came; in malloc's heap each exchange
// of organs would leave other holes (docs/decisions/memory_locking.md). DDS, in C, takes its buffers from malloc, and
// maps nothing for them. Not a source of the server's parts: it is for the process as a whole.
#include <sys/mman.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <new>

namespace palpate::server {
namespace {

constexpr std::size_t kApart = std::size_t{64} * 1024;  // bytes
constexpr std::size_t kPage = 4096;
constexpr std::size_t kMostTables = 1024;  // a model has some hundred; what comes on top is malloc's

// Without a lock, which a thread of a high priority could have to wait for. An address that is no multiple of a page is malloc's,
// and needs no look.
class Mappings {
 public:
  // @return null: there is no room, here or in memory
  void* add(std::size_t bytes) noexcept {
    Mapping* const free = std::find_if(mappings_.begin(), mappings_.end(), [](Mapping& mapping) {
      void* nobodys = nullptr;
      // Taken; its size may be written, since whoever freed it has read that.
      return mapping.begin.compare_exchange_strong(nobodys, &mapping, std::memory_order_acquire,
                                                   std::memory_order_relaxed);
    });
    if (free == mappings_.end()) return nullptr;
    void* const begin = mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    const bool mapped = begin != MAP_FAILED;
    free->bytes = bytes;
    free->begin.store(mapped ? begin : nullptr, std::memory_order_release);  // to who frees it
    return mapped ? begin : nullptr;
  }

  // @return false: it is not one of these
  bool remove(void* begin) noexcept {
    Mapping* const found = std::find_if(mappings_.begin(), mappings_.end(), [begin](const Mapping& mapping) {
      return mapping.begin.load(std::memory_order_acquire) == begin;
    });
    if (found == mappings_.end()) return false;
    const std::size_t bytes = found->bytes;
    found->begin.store(nullptr, std::memory_order_release);  // and so after the size was read
    munmap(begin, bytes);
    return true;
  }

 private:
  struct Mapping {
    std::atomic<void*> begin{nullptr};
    std::size_t bytes{0};
  };
  std::array<Mapping, kMostTables> mappings_{};
};

constinit Mappings mappings;

bool isOfAPage(const void* memory) noexcept {
  return std::bit_cast<std::uintptr_t>(memory) % kPage == 0;
}

void* fromMalloc(std::size_t bytes, std::size_t alignment) {
  const std::size_t whole = (std::max(bytes, std::size_t{1}) + alignment - 1) / alignment * alignment;
  for (;;) {
    void* const memory = whole < bytes ? nullptr : std::aligned_alloc(alignment, whole);
    if (memory != nullptr) return memory;
    const std::new_handler handler = std::get_new_handler();
    if (handler == nullptr) throw std::bad_alloc();
    handler();
  }
}

void* allocate(std::size_t bytes, std::size_t alignment) {
  if (bytes >= kApart && alignment <= kPage)
    if (void* const begin = mappings.add(bytes)) return begin;
  return fromMalloc(bytes, alignment);
}

}  // namespace
}  // namespace palpate::server

// All other forms of new and delete end in these.
void* operator new(std::size_t bytes) {
  return palpate::server::allocate(bytes, __STDCPP_DEFAULT_NEW_ALIGNMENT__);
}

void* operator new(std::size_t bytes, std::align_val_t alignment) {
  return palpate::server::allocate(bytes, static_cast<std::size_t>(alignment));
}

void operator delete(void* memory) noexcept {
  using namespace palpate::server;
  if (memory == nullptr || (isOfAPage(memory) && mappings.remove(memory))) return;
  std::free(memory);
}

void operator delete(void* memory, std::align_val_t) noexcept {
  ::operator delete(memory);
}

void operator delete(void* memory, std::size_t) noexcept {
  ::operator delete(memory);
}

void operator delete(void* memory, std::size_t, std::align_val_t) noexcept {
  ::operator delete(memory);
}
