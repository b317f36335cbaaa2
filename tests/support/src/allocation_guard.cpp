// SPDX-License-Identifier: Apache-2.0
#include "palpate/testing/allocation_guard.h"

#include <cstdlib>
#include <new>

namespace {

thread_local bool armed = false;
thread_local std::size_t counted = 0;

void note() noexcept {
  if (armed) ++counted;
}

void* allocateOrNull(std::size_t size) noexcept {
  note();
  return std::malloc(size == 0 ? 1 : size);
}

void* allocateAlignedOrNull(std::size_t size, std::align_val_t alignment) noexcept {
  note();
  const auto step = static_cast<std::size_t>(alignment);
  return std::aligned_alloc(step, (size + step - 1) / step * step);
}

void* orThrow(void* memory) {
  if (memory == nullptr) throw std::bad_alloc();
  return memory;
}

void* allocate(std::size_t size) {
  return orThrow(allocateOrNull(size));
}

void* allocateAligned(std::size_t size, std::align_val_t alignment) {
  return orThrow(allocateAlignedOrNull(size, alignment));
}

void release(void* memory) noexcept {
  note();
  std::free(memory);
}

}  // namespace

void* operator new(std::size_t size) {
  return allocate(size);
}
void* operator new[](std::size_t size) {
  return allocate(size);
}
void* operator new(std::size_t size, std::align_val_t alignment) {
  return allocateAligned(size, alignment);
}
void* operator new[](std::size_t size, std::align_val_t alignment) {
  return allocateAligned(size, alignment);
}
// Those that return nothing rather than throw: the libraries' own call another operator new than ours, and what they
// return goes to our operator delete.
void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
  return allocateOrNull(size);
}
void* operator new[](std::size_t size, const std::nothrow_t&) noexcept {
  return allocateOrNull(size);
}
void* operator new(std::size_t size, std::align_val_t alignment, const std::nothrow_t&) noexcept {
  return allocateAlignedOrNull(size, alignment);
}
void* operator new[](std::size_t size, std::align_val_t alignment, const std::nothrow_t&) noexcept {
  return allocateAlignedOrNull(size, alignment);
}
void operator delete(void* memory) noexcept {
  release(memory);
}
void operator delete[](void* memory) noexcept {
  release(memory);
}
void operator delete(void* memory, std::size_t) noexcept {
  release(memory);
}
void operator delete[](void* memory, std::size_t) noexcept {
  release(memory);
}
void operator delete(void* memory, std::align_val_t) noexcept {
  release(memory);
}
void operator delete[](void* memory, std::align_val_t) noexcept {
  release(memory);
}
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept {
  release(memory);
}
void operator delete[](void* memory, std::size_t, std::align_val_t) noexcept {
  release(memory);
}

#if !PALPATE_SANITIZER_HAS_MALLOC
// glibc's own entry points; the public names are ours to replace.
extern "C" {
void* __libc_malloc(std::size_t size);
void* __libc_calloc(std::size_t count, std::size_t size);
void* __libc_realloc(void* memory, std::size_t size);
void __libc_free(void* memory);

void* malloc(std::size_t size) noexcept {
  note();
  return __libc_malloc(size);
}
void* calloc(std::size_t count, std::size_t size) noexcept {
  note();
  return __libc_calloc(count, size);
}
void* realloc(void* memory, std::size_t size) noexcept {
  note();
  return __libc_realloc(memory, size);
}
void free(void* memory) noexcept {
  note();
  __libc_free(memory);
}
}
#endif

namespace palpate::testing {

AllocationGuard::AllocationGuard() noexcept {
  counted = 0;
  armed = true;
}

AllocationGuard::~AllocationGuard() {
  armed = false;
}

std::size_t AllocationGuard::count() const noexcept {
  return counted;
}

}  // namespace palpate::testing
