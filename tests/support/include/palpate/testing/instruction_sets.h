// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>
#include <hwy/targets.h>

#include <cstdint>
#include <vector>

#include "core/base/kernels.h"

namespace palpate::testing {

/// Every instruction set that this processor has, then all again.
class InstructionSets {
 public:
  InstructionSets() {
    std::int64_t all = hwy::SupportedTargets();
    for (; all != 0; all &= all - 1) list_.push_back(all & -all);
  }
  InstructionSets(const InstructionSets&) = delete;
  InstructionSets& operator=(const InstructionSets&) = delete;
  ~InstructionSets() {
    hwy::SetSupportedTargetsForTest(0);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
  }
  [[nodiscard]] const std::vector<std::int64_t>& list() const { return list_; }

 private:
  std::vector<std::int64_t> list_;
};

/// Calls use() with each instruction set.
template <class Use>
void withEach(const InstructionSets& sets, const Use& use) {
  for (const std::int64_t set : sets.list()) {
    SCOPED_TRACE(hwy::TargetName(set));
    hwy::SetSupportedTargetsForTest(set);
    chooseKernels();
    use();
  }
}

}  // namespace palpate::testing
