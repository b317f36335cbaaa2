// SPDX-License-Identifier: Apache-2.0
// What libFuzzer calls. PALPATE_FUZZ_TARGET is a function of targets.h, PALPATE_FUZZ_MEND one that corrects its checksums.
#include "targets.h"

constexpr double kMost = 10.0;  // s of processor time for an input, under sanitizers

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  (void)palpate::fuzz::soonEnough(palpate::fuzz::PALPATE_FUZZ_TARGET, {data, size}, kMost);
  return 0;
}

#ifdef PALPATE_FUZZ_MEND
extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t most);

// One input in sixteen stays as it is: wrong checksums are refused.
extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t most,
                                               unsigned seed) {
  size = LLVMFuzzerMutate(data, size, most);
  if (seed % 16 != 0) palpate::fuzz::PALPATE_FUZZ_MEND({data, size});
  return size;
}
#endif
