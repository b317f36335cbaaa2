// SPDX-License-Identifier: Apache-2.0
#include "tools/examine/bench/eigen_product.h"

#include "tools/examine/bench/eigen_variants.h"

namespace palpate::bench {

namespace {

struct Variant {
  const char* name;
  EigenProduct* product;
};

Variant widest() {
#if defined(PALPATE_EIGEN_VARIANTS)
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq"))
    return {"avx512", &eigenAvx512};
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) return {"avx2", &eigenAvx2};
#endif
  return {"baseline", &eigenBaseline};
}

}  // namespace

void eigenProduct(std::span<const float> X, std::span<const float> y, std::span<float> u) {
  static const Variant variant = widest();
  variant.product(X.data(), y.data(), u.data(), static_cast<long>(u.size()), static_cast<long>(y.size()));
}

const char* eigenInstructions() {
  return widest().name;
}

}  // namespace palpate::bench
