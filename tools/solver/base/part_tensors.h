// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tools/solver/base/lanes.h"

namespace palpate::solver {

/// What a multiversioned kernel calls: the compiler inlines it into each clone and so builds it for each target.
#define PALPATE_INLINE [[gnu::always_inline]] inline

/// The lanes that one AVX2 register holds. GCC splits operations on a whole Lanes through the stack, so the
/// kernels visit each integration point once per part, and whole Lanes are in memory only.
using Part [[gnu::vector_size(4 * sizeof(double)), gnu::may_alias]] = double;
inline constexpr int kParts = sizeof(Lanes) / sizeof(Part);
static_assert(sizeof(Lanes) % sizeof(Part) == 0);

PALPATE_INLINE const Part& partOf(const Lanes& x, int part) {
  return reinterpret_cast<const Part*>(&x)[part];
}
PALPATE_INLINE Part& partOf(Lanes& x, int part) {
  return reinterpret_cast<Part*>(&x)[part];
}

/// What a kernel holds in one register: a part of the lanes in double, all of them in float.
template <typename Scalar>
struct RegisterOf;
template <>
struct RegisterOf<double> {
  using Type = Part;
};
template <>
struct RegisterOf<float> {
  using Type = FloatLanes;
};

/// General 3 x 3, row-major: H, F, P.
template <typename Scalar>
struct Tensor {
  typename RegisterOf<Scalar>::Type v[9];
};
/// xx yy zz yz xz xy. Strains hold twice the shear, stresses once: S : E is then a sum of six.
template <typename Scalar>
struct Symmetric {
  typename RegisterOf<Scalar>::Type v[6];
};
using PartTensor = Tensor<double>;
using PartSymmetric = Symmetric<double>;

/// T += A^T B. Nine sums that do not wait for each other.
template <typename Scalar>
PALPATE_INLINE void addTransposeTimes(const Tensor<Scalar>& A, const Tensor<Scalar>& B, Tensor<Scalar>& T) {
  for (int i = 0; i < 3; ++i)
    for (int I = 0; I < 3; ++I)
      for (int J = 0; J < 3; ++J) T.v[3 * I + J] += A.v[3 * i + I] * B.v[3 * i + J];
}

/// t += A^T A / 2, with twice the shear.
template <typename Scalar>
PALPATE_INLINE void addSquare(const Tensor<Scalar>& A, Symmetric<Scalar>& t) {
  constexpr Scalar kHalf = 0.5;
  for (int i = 0; i < 3; ++i) {
    const auto* a = A.v + 3 * i;
    for (int J = 0; J < 3; ++J) t.v[J] += kHalf * a[J] * a[J];
    t.v[3] += a[1] * a[2];
    t.v[4] += a[0] * a[2];
    t.v[5] += a[0] * a[1];
  }
}

/// t += sym T, with twice the shear.
template <typename Scalar>
PALPATE_INLINE void addSym(const Tensor<Scalar>& T, Symmetric<Scalar>& t) {
  for (int J = 0; J < 3; ++J) t.v[J] += T.v[4 * J];
  t.v[3] += T.v[5] + T.v[7];
  t.v[4] += T.v[2] + T.v[6];
  t.v[5] += T.v[1] + T.v[3];
}

/// P += H S
PALPATE_INLINE void addTimes(const PartTensor& H, const PartSymmetric& S, PartTensor& P) {
  for (int i = 0; i < 3; ++i) {
    const Part* h = H.v + 3 * i;
    P.v[3 * i] += h[0] * S.v[0] + h[1] * S.v[5] + h[2] * S.v[4];
    P.v[3 * i + 1] += h[0] * S.v[5] + h[1] * S.v[1] + h[2] * S.v[3];
    P.v[3 * i + 2] += h[0] * S.v[4] + h[1] * S.v[3] + h[2] * S.v[2];
  }
}

/// P = S
PALPATE_INLINE void asTensor(const PartSymmetric& S, PartTensor& P) {
  constexpr int kAt[9] = {0, 5, 4, 5, 1, 3, 4, 3, 2};
  for (int i = 0; i < 9; ++i) P.v[i] = S.v[kAt[i]];
}

}  // namespace palpate::solver
