// SPDX-License-Identifier: Apache-2.0
// What one of several ranks takes.
#include <gtest/gtest.h>

#include "tools/mesh/box_mesh.h"
#include "tools/solver/build/displacement_builder.h"

namespace palpate::solver {
namespace {

/// Says who it is; nobody is there to talk to.
class NumberedRank : public Ranks {
 public:
  NumberedRank(int rank, int size) : rank_(rank), size_(size) {}
  [[nodiscard]] int rank() const noexcept override { return rank_; }
  [[nodiscard]] int size() const noexcept override { return size_; }

 private:
  int rank_, size_;
};

class RankSizes : public ::testing::Test {
 protected:
  RankSizes() {
    for (std::int32_t node = 0; node < static_cast<std::int32_t>(block_.nodes.size()); ++node)
      if (block_.nodes[static_cast<std::size_t>(node)].x() < 1e-9) block_.groups["fixed"].push_back(node);
    case_.mesh = "block";
    case_.order = 3;
    case_.force_order = 3;
  }
  [[nodiscard]] double scratch(int rank, int size) const {
    const NumberedRank ranks(rank, size);
    BuildOptions options{.workers = 1, .quiet = true, .ranks = &ranks};
    BuildReport report;
    const ChosenOrgan organ(case_, block_, options, report);
    return DisplacementBuilder(organ, options, report).sizes().scratch;
  }

  mesh::TetMesh block_ = mesh::makeBox({0.06, 0.05, 0.04}, {5, 4, 4});
  Case case_;
};

TEST_F(RankSizes, ShareTheScratchOfOneProcess) {
  const double one = scratch(0, 1);
  ASSERT_GT(one, 0.0);
  for (const int size : {2, 3}) {
    double all = 0.0;
    for (int rank = 0; rank < size; ++rank) {
      EXPECT_LT(scratch(rank, size), 0.7 * one) << rank << " of " << size;
      all += scratch(rank, size);
    }
    EXPECT_DOUBLE_EQ(all, one) << size;
  }
}

}  // namespace
}  // namespace palpate::solver
