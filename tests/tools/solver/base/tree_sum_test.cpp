// SPDX-License-Identifier: Apache-2.0
#include "tools/solver/base/tree_sum.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <cstring>
#include <functional>
#include <map>
#include <mutex>
#include <numeric>
#include <random>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <vector>

namespace palpate::solver {
namespace {

/// Ranks that are threads of this process: what they move goes through a mailbox.
class Mailbox {
 public:
  void put(int from, int to, std::span<const std::byte> data) {
    const std::lock_guard lock(mutex_);
    letters_[{from, to}].emplace_back(data.begin(), data.end());
    arrived_.notify_all();
  }
  void take(int from, int to, std::span<std::byte> data) {
    std::unique_lock lock(mutex_);
    auto& letters = letters_[{from, to}];
    if (!arrived_.wait_for(lock, kLongest, [&] { return !letters.empty() || stuck_; }) || letters.empty()) {
      stuck_ = true;
      arrived_.notify_all();
      throw std::runtime_error("nothing came from rank " + std::to_string(from) + " to " +
                               std::to_string(to));
    }
    ASSERT_EQ(letters.front().size(), data.size());
    std::copy(letters.front().begin(), letters.front().end(), data.begin());
    letters.erase(letters.begin());
  }

 private:
  static constexpr std::chrono::seconds kLongest{10};

  std::mutex mutex_;
  std::condition_variable arrived_;
  bool stuck_{false};  ///< a rank has waited for what nobody sends: all end
  std::map<std::pair<int, int>, std::vector<std::vector<std::byte>>> letters_;
};

class ThreadRank : public Ranks {
 public:
  ThreadRank(int rank, int size, Mailbox& mailbox) : rank_(rank), size_(size), mailbox_(mailbox) {}
  [[nodiscard]] int rank() const noexcept override { return rank_; }
  [[nodiscard]] int size() const noexcept override { return size_; }
  void broadcast(std::span<std::byte> data, int from) const override {
    if (rank_ != from) return mailbox_.take(from, rank_, data);
    for (int to = 0; to < size_; ++to)
      if (to != from) mailbox_.put(from, to, data);
  }
  void move(std::span<std::byte> data, int from, int to) const override {
    if (rank_ == from) mailbox_.put(from, to, data);
    if (rank_ == to) mailbox_.take(from, to, data);
  }

 private:
  int rank_, size_;
  Mailbox& mailbox_;
};

void onRanks(int size, const std::function<void(const Ranks&)>& work) {
  Mailbox mailbox;
  std::vector<std::jthread> threads;
  for (int rank = 0; rank < size; ++rank)
    threads.emplace_back([&, rank] {
      try {
        work(ThreadRank(rank, size, mailbox));
      } catch (const std::exception& error) {
        ADD_FAILURE() << "rank " << rank << " of " << size << ": " << error.what();
      }
    });
}

std::vector<std::int32_t> upTo(std::size_t entries) {
  std::vector<std::int32_t> order(entries);
  std::iota(order.begin(), order.end(), 0);
  return order;
}

/// Numbers whose sum depends on the order.
Eigen::MatrixXf partOf(std::size_t block) {
  std::mt19937 random(static_cast<std::mt19937::result_type>(block));
  std::normal_distribution<float> normal;
  return Eigen::MatrixXf::NullaryExpr(5, 3, [&] { return normal(random); });
}

Eigen::MatrixXf sumOf(const Blocks& blocks, unsigned seed) {
  std::vector<std::size_t> own(blocks.firstOf(blocks.ranks().rank() + 1) -
                               blocks.firstOf(blocks.ranks().rank()));
  std::iota(own.begin(), own.end(), blocks.firstOf(blocks.ranks().rank()));
  std::shuffle(own.begin(), own.end(), std::mt19937(seed));
  TreeSum<Eigen::MatrixXf> sum(blocks, 5, 3);
  for (const std::size_t block : own) sum.add(block, partOf(block));
  return sum.finish();
}

TEST(Ranks, AgreeWhereOneSaysNo) {
  for (const int size : {1, 2, 3})
    for (int no = -1; no < size; ++no)
      onRanks(size, [&](const Ranks& ranks) { EXPECT_EQ(ranks.all(ranks.rank() != no), no < 0); });
}

TEST(TreeSum, HasTheSameBitsForAnyOrderAndAnyNumberOfRanks) {
  for (const std::size_t entries : {1U, 3U, 8U, 60U, 230U, 413U}) {
    const Eigen::MatrixXf one = sumOf(Blocks(upTo(entries), 1, 8, Ranks::one()), 0);
    Eigen::MatrixXd exact = Eigen::MatrixXd::Zero(5, 3);
    for (std::size_t b = 0; b < Blocks(upTo(entries), 1, 8, Ranks::one()).count(); ++b)
      exact += partOf(b).cast<double>();
    EXPECT_LT((one.cast<double>() - exact).norm(), 1e-5 * exact.norm());
    for (const int size : {1, 2, 3, 4, 7}) {
      if (HasFailure()) return;  // the next one might wait as long again
      onRanks(size, [&](const Ranks& ranks) {
        const Eigen::MatrixXf sum = sumOf(Blocks(upTo(entries), 1, 8, ranks), 7);
        EXPECT_EQ(std::memcmp(sum.data(), one.data(), 15 * sizeof(float)), 0)
            << entries << " entries, " << size << " ranks";
      });
    }
  }
}

TEST(TreeSum, OfNoBlocksIsZero) {
  EXPECT_EQ(TreeSum<Eigen::MatrixXf>(Blocks(0), 2, 2).finish(), Eigen::MatrixXf::Zero(2, 2));
}

TEST(Blocks, HoldEachEntryOnceInWholePartsOfAtMostWhatIsAsked) {
  for (const std::size_t entries : {0U, 1U, 7U, 9U, 100U, 447U, 800U, 1919U})
    for (const int size : {1, 2, 3, 5})
      onRanks(size, [&](const Ranks& ranks) {
        const Blocks blocks(upTo(entries), 8, 64, ranks);
        EXPECT_EQ(blocks.begin(0), 0U);
        EXPECT_EQ(blocks.begin(blocks.count()), entries);
        for (std::size_t b = 0; b < blocks.count(); ++b) {
          EXPECT_EQ(blocks.begin(b) % 8, 0U);
          EXPECT_FALSE(blocks.block(b).empty());
          EXPECT_LE(blocks.block(b).size(), 64U);
          const int rank = blocks.rankOf(b);
          EXPECT_LE(blocks.firstOf(rank), b);
          EXPECT_LT(b, blocks.firstOf(rank + 1));
        }
        EXPECT_EQ(blocks.firstOf(size), blocks.count());
      });
}

TEST(Blocks, ShareWhatEachRankHas) {
  onRanks(3, [&](const Ranks& ranks) {
    std::vector<std::int32_t> order = upTo(50);
    std::reverse(order.begin(), order.end());
    const Blocks blocks(order, 1, 4, ranks);
    std::vector<std::vector<int>> lists(50);
    for (std::size_t i = 0; i < 50; ++i) lists[i].assign(i % 3, -1);
    for (std::size_t i = blocks.ownBegin(); i < blocks.ownEnd(); ++i)
      for (int& number : lists[static_cast<std::size_t>(order[i])]) number = order[i];
    share(blocks, [&](std::int32_t i) { return std::span(lists[static_cast<std::size_t>(i)]); });
    for (std::size_t i = 0; i < 50; ++i)
      EXPECT_EQ(lists[i], std::vector<int>(i % 3, static_cast<int>(i))) << ranks.rank();
  });
}

}  // namespace
}  // namespace palpate::solver
