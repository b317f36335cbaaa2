// SPDX-License-Identifier: Apache-2.0
#include "tools/solver/fem/block_kernel.h"

#include <cstddef>
#include <cstdint>
#include <type_traits>

// Compiled once for each instruction set; the first call finds the best that the processor has.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "tools/solver/fem/block_kernel.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h, as Highway asks.
#include <hwy/cache_control.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace palpate::solver {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Tag = hn::CappedTag<double, kLanes>;
using Vector = hn::Vec<Tag>;

/// Rows or columns of L whose sums are in registers at once, beside two vectors of the right-hand sides.
constexpr int kTile = HWY_TARGET <= HWY_AVX3 ? 8 : 4;

/// Calls with a size, T or a power of two below it, and where it begins: as large tiles as there is room for.
template <int T, typename Do>
HWY_INLINE void inTiles(int begin, int end, const Do& tile) {
  for (; begin + T <= end; begin += T) tile(std::integral_constant<int, T>(), begin);
  if constexpr (T > 1) inTiles<T / 2>(begin, end, tile);
}

/// What lies so many numbers on, which may be behind the end of the factor.
HWY_INLINE void fetch(const double* from, std::size_t numbers) {
  hwy::Prefetch(
      reinterpret_cast<const double*>(reinterpret_cast<std::uintptr_t>(from) + numbers * sizeof(double)));
}

constexpr int kVectors = 3;        ///< of a row of right-hand sides
constexpr std::size_t kAhead = 8;  ///< columns of L that are fetched before they are needed

/// One block of L, and a panel of the right-hand sides: V vectors of each row.
template <int V>
class Panel {
 public:
  HWY_INLINE Panel(const BlockOfL& block, double* b, std::size_t stride)
      : block_(block), stride_(stride), own_(b + static_cast<std::size_t>(block.first) * stride), b_(b) {}

  HWY_INLINE void forward() {
    const int columns = block_.columns;
    inTiles<kTile>(0, columns, [&](auto tile, int r) HWY_ATTR { forwardTile<tile()>(r, r, tile()); });
    inTiles<kTile>(columns, block_.stride,
                   [&](auto tile, int r) HWY_ATTR { forwardTile<tile()>(r, columns, 0); });
  }

  HWY_INLINE void backward() {
    const int columns = block_.columns;
    inTiles<kTile>(0, columns,
                   [&](auto tile, int c) HWY_ATTR { backwardTile<tile()>(columns - c - tile()); });
  }

 private:
  static constexpr std::size_t kVector = hn::MaxLanes(Tag());

  HWY_INLINE double* rowAt(int r) const {
    return r < block_.columns
               ? own_ + static_cast<std::size_t>(r) * stride_
               : b_ + static_cast<std::size_t>(block_.below[static_cast<std::size_t>(r - block_.columns)]) *
                          stride_;
  }
  HWY_INLINE const double* columnAt(int c) const {
    return block_.values + static_cast<std::size_t>(c) * static_cast<std::size_t>(block_.stride);
  }

  /// Rows r to r + R less L times the first `known` rows; of the next `own` columns L has the triangle.
  template <int R>
  HWY_INLINE void forwardTile(int r, int known, int own) {
    const Tag d;
    Vector sum[R][V];
    for (int i = 0; i < R; ++i)
      for (int v = 0; v < V; ++v) sum[i][v] = hn::LoadU(d, rowAt(r + i) + v * kVector);
    const double* x = own_;
    const double* L = block_.values + r;
    for (int k = 0; k < known; ++k, x += stride_, L += block_.stride) {
      fetch(L, kAhead * static_cast<std::size_t>(block_.stride));
      Vector xk[V];
      for (int v = 0; v < V; ++v) xk[v] = hn::LoadU(d, x + v * kVector);
      for (int i = 0; i < R; ++i) {
        const Vector l = hn::Set(d, L[i]);
        for (int v = 0; v < V; ++v) sum[i][v] = hn::NegMulAdd(l, xk[v], sum[i][v]);
      }
    }
    for (int k = 0; k < own; ++k, L += block_.stride) {
      const Vector inverse = hn::Set(d, 1.0 / L[k]);
      for (int v = 0; v < V; ++v) sum[k][v] = hn::Mul(sum[k][v], inverse);
      for (int i = k + 1; i < own; ++i) {
        const Vector l = hn::Set(d, L[i]);
        for (int v = 0; v < V; ++v) sum[i][v] = hn::NegMulAdd(l, sum[k][v], sum[i][v]);
      }
    }
    for (int i = 0; i < R; ++i)
      for (int v = 0; v < V; ++v) hn::StoreU(sum[i][v], d, rowAt(r + i) + v * kVector);
  }

  /// Rows c to c + C of x, where all later ones are known.
  template <int C>
  HWY_INLINE void backwardTile(int c) {
    const Tag d;
    Vector sum[C][V];
    for (int i = 0; i < C; ++i)
      for (int v = 0; v < V; ++v) sum[i][v] = hn::LoadU(d, rowAt(c + i) + v * kVector);
    const double* L = columnAt(c);
    const auto subtract = [&](int r, const double* x) HWY_ATTR {
      Vector xr[V];
      for (int v = 0; v < V; ++v) xr[v] = hn::LoadU(d, x + v * kVector);
      for (int i = 0; i < C; ++i) {
        const Vector l = hn::Set(d, L[i * static_cast<std::ptrdiff_t>(block_.stride) + r]);
        for (int v = 0; v < V; ++v) sum[i][v] = hn::NegMulAdd(l, xr[v], sum[i][v]);
      }
    };
    int r = c + C;
    for (; r < block_.columns; ++r) subtract(r, own_ + static_cast<std::size_t>(r) * stride_);
    for (const int row : block_.below) subtract(r++, b_ + static_cast<std::size_t>(row) * stride_);
    for (int k = C; k-- > 0;) {
      const Vector inverse = hn::Set(d, 1.0 / columnAt(c + k)[c + k]);
      for (int v = 0; v < V; ++v) sum[k][v] = hn::Mul(sum[k][v], inverse);
      for (int i = 0; i < k; ++i) {
        const Vector l = hn::Set(d, columnAt(c + i)[c + k]);
        for (int v = 0; v < V; ++v) sum[i][v] = hn::NegMulAdd(l, sum[k][v], sum[i][v]);
      }
    }
    for (int i = 0; i < C; ++i)
      for (int v = 0; v < V; ++v) hn::StoreU(sum[i][v], d, rowAt(c + i) + v * kVector);
  }

  const BlockOfL& block_;
  std::size_t stride_;  // of rows of b
  double* own_;
  double* b_;
};

/// Calls for panels of V vectors of each row, or fewer at the end.
template <int V, typename Do>
HWY_INLINE void forPanels(double* begin, double* end, const Do& panel) {
  constexpr std::size_t kWidth = V * hn::MaxLanes(Tag());
  for (; begin + kWidth <= end; begin += kWidth) panel(std::integral_constant<int, V>(), begin);
  if constexpr (V > 1) forPanels<V - 1>(begin, end, panel);
}

void Forward(const BlockOfL& block, double* b, std::size_t columns) {
  forPanels<kVectors>(b, b + columns, [&](auto vectors, double* at) HWY_ATTR {
    Panel<vectors()>(block, at, columns).forward();
  });
}

void Backward(const BlockOfL& block, double* b, std::size_t columns) {
  forPanels<kVectors>(b, b + columns, [&](auto vectors, double* at) HWY_ATTR {
    Panel<vectors()>(block, at, columns).backward();
  });
}

std::string Name() {
  return hwy::TargetName(HWY_TARGET);
}

}  // namespace HWY_NAMESPACE
}  // namespace palpate::solver
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace palpate::solver {
namespace {
HWY_EXPORT(Forward);
HWY_EXPORT(Backward);
HWY_EXPORT(Name);
}  // namespace

void solveForward(const BlockOfL& block, Lanes* b, int lanes) {
  HWY_DYNAMIC_DISPATCH(Forward)
  (block, reinterpret_cast<double*>(b), static_cast<std::size_t>(lanes) * kLanes);
}

void solveBackward(const BlockOfL& block, Lanes* b, int lanes) {
  HWY_DYNAMIC_DISPATCH(Backward)
  (block, reinterpret_cast<double*>(b), static_cast<std::size_t>(lanes) * kLanes);
}

std::string blockKernel() {
  return HWY_DYNAMIC_DISPATCH(Name)();
}

}  // namespace palpate::solver
#endif
