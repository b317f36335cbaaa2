// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <string>

#include "tools/solver/build/estimate.h"

namespace palpate::solver {
namespace {

constexpr double kTooMuch = 1e18;  // bytes, which no machine has

std::string refusal(const Estimate& estimate, Target target = Target::kServer,
                    const Ranks& ranks = Ranks::one()) {
  Case c;
  c.mesh = "organ.msh";
  c.order = 4;
  c.target = target;
  try {
    requireRoom(estimate, c, {.workers = 2, .scratch = ".", .ranks = &ranks}, ".");
  } catch (const CaseError& error) {
    return error.what();
  }
  return {};
}

bool says(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST(RequireRoom, TakesWhatFits) {
  EXPECT_EQ(refusal({}), "");
  Estimate there;  // most of it is resident already
  there.memory = kTooMuch;
  there.resident = kTooMuch;
  EXPECT_EQ(refusal(there), "");
}

/// As many processes on this machine as none has room for.
class CrowdedRanks : public Ranks {
 public:
  [[nodiscard]] int onMachine() const noexcept override { return 1000000; }
};

TEST(RequireRoom, SharesTheMachinesMemoryAmongItsRanks) {
  Estimate estimate;
  estimate.memory = 1e8;
  EXPECT_EQ(refusal(estimate), "");
  const std::string text = refusal(estimate, Target::kServer, CrowdedRanks());
  EXPECT_TRUE(says(text, ", shared by 1000000 processes): fewer processes, --threads")) << text;
}

TEST(RequireRoom, NamesTheFolderOfTheScratchAndWhatNeedsLess) {
  Estimate estimate;
  estimate.scratch = kTooMuch;
  const std::string text = refusal(estimate);
  EXPECT_TRUE(says(text, ".: needs 1000000000.00 GB of scratch, ")) << text;
  EXPECT_TRUE(says(text, "--scratch")) << text;
  EXPECT_TRUE(says(text, "--order 3 (about 558823529.41 GB)")) << text;  // 19 of 34 coefficients
}

TEST(RequireRoom, NamesWhatMakesAFileSmaller) {
  Estimate estimate;
  estimate.file = kTooMuch;
  EXPECT_TRUE(says(refusal(estimate), "the model file needs about 1000000000.00 GB")) << refusal(estimate);
  EXPECT_TRUE(says(refusal(estimate), "--target handheld")) << refusal(estimate);
  EXPECT_TRUE(says(refusal(estimate, Target::kHandheld), "--size-limit")) << "it is handheld already";
}

TEST(RequireRoom, NamesTheMeshAndTheMemory) {
  Estimate estimate;
  estimate.memory = kTooMuch;
  const std::string text = refusal(estimate);
  EXPECT_TRUE(says(text, "organ.msh: needs about 1000000000.00 GB of memory, ")) << text;
  EXPECT_TRUE(says(text, "--threads")) << text;
}

}  // namespace
}  // namespace palpate::solver
