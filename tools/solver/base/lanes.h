// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <new>
#include <vector>

namespace palpate::solver {

/// Several contact positions share the same arithmetic: their numbers lie side by side and fill the registers
/// of a vector unit of any width.
inline constexpr int kLanes = 8;
using Lanes = double __attribute__((vector_size(kLanes * sizeof(double))));
/// The same in single precision: one AVX2 register.
using FloatLanes = float __attribute__((vector_size(kLanes * sizeof(float))));

/// A kernel built for several instruction sets, chosen when the program starts.
#ifdef PALPATE_HAVE_TARGET_CLONES
#define PALPATE_MULTIVERSION __attribute__((target_clones("default", "arch=x86-64-v3", "arch=x86-64-v4")))
#else
#define PALPATE_MULTIVERSION
#endif

/// Aligns Lanes for the widest vector unit: as a template argument the type loses its alignment.
template <typename T>
struct LaneAllocator {
  using value_type = T;
  static constexpr std::align_val_t kAlignment{kLanes * sizeof(double)};
  LaneAllocator() = default;
  template <typename U>
  explicit LaneAllocator(const LaneAllocator<U>& /*other*/) noexcept {}
  T* allocate(std::size_t n) { return static_cast<T*>(::operator new(n * sizeof(T), kAlignment)); }
  void deallocate(T* p, std::size_t /*n*/) noexcept { ::operator delete(p, kAlignment); }
  bool operator==(const LaneAllocator& /*other*/) const noexcept { return true; }
};

using LaneVector = std::vector<Lanes, LaneAllocator<Lanes>>;
using FloatLaneVector = std::vector<FloatLanes, LaneAllocator<FloatLanes>>;

}  // namespace palpate::solver
