// SPDX-License-Identifier: Apache-2.0
#pragma once

// A kernel marked so is compiled for several instruction sets; the loader of the program picks one at start.
// Results differ between them in rounding only.
#if defined(PALPATE_HAVE_TARGET_CLONES)
#define PALPATE_MULTIVERSION __attribute__((target_clones("avx512f", "avx2,fma", "default")))
#else
#define PALPATE_MULTIVERSION
#endif
