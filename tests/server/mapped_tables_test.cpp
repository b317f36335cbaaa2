// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <sys/mman.h>

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <new>
#include <thread>
#include <vector>

namespace palpate::server {
namespace {

constexpr std::size_t kPage = 4096;
constexpr std::size_t kLarge = std::size_t{64} * 1024;

bool isMapped(void* page) {
  unsigned char in_memory = 0;
  return mincore(page, kPage, &in_memory) == 0;
}

bool isOfAPage(const void* memory) {
  return std::bit_cast<std::uintptr_t>(memory) % kPage == 0;
}

TEST(MappedTables, LargePiecesGoBackToTheSystemAndSmallOnesStay) {
  for (const std::size_t bytes : {kLarge, kLarge + 1, 40 * kLarge}) {
    void* const large = ::operator new(bytes);
    ASSERT_TRUE(isOfAPage(large));
    static_cast<volatile char*>(large)[bytes - 1] = 1;
    EXPECT_TRUE(isMapped(large));
    ::operator delete(large);
    EXPECT_FALSE(isMapped(large)) << bytes;
  }
  void* const small = ::operator new(kLarge - 1);
  void* const page = static_cast<char*>(small) - std::bit_cast<std::uintptr_t>(small) % kPage;
  ::operator delete(small);
  EXPECT_TRUE(isMapped(page)) << "malloc keeps it";
}

TEST(MappedTables, EveryFormOfNewEndsInIt) {
  auto bytes = std::make_unique<char[]>(kLarge);
  EXPECT_TRUE(isOfAPage(bytes.get()));
  const std::unique_ptr<char[]> quiet(new (std::nothrow) char[kLarge]);
  EXPECT_TRUE(isOfAPage(quiet.get()));
  const std::vector<double> table(kLarge);
  EXPECT_TRUE(isOfAPage(table.data()));
  struct alignas(64) Row {
    double values[8];
  };
  auto rows = std::make_unique<std::vector<Row>>(kLarge);
  EXPECT_TRUE(isOfAPage(rows->data()));
  void *const of_bytes = bytes.get(), *const of_rows = rows->data();
  bytes.reset();
  rows.reset();
  EXPECT_FALSE(isMapped(of_bytes));
  EXPECT_FALSE(isMapped(of_rows));
  const auto small = std::make_unique<Row>();
  EXPECT_EQ(std::bit_cast<std::uintptr_t>(small.get()) % alignof(Row), 0U);
}

TEST(MappedTables, MoreThanThereIsRoomForAreMallocs) {
  std::vector<std::unique_ptr<char[]>> pieces;
  for (int i = 0; i < 1500; ++i) {
    pieces.push_back(std::make_unique_for_overwrite<char[]>(kLarge));
    pieces.back()[kLarge - 1] = static_cast<char>(i);
  }
  for (int i = 0; i < 1500; ++i)
    ASSERT_EQ(pieces[static_cast<std::size_t>(i)][kLarge - 1], static_cast<char>(i));
  const auto apart =
      std::count_if(pieces.begin(), pieces.end(), [](const auto& piece) { return isOfAPage(piece.get()); });
  EXPECT_GT(apart, 900);
  EXPECT_LT(apart, 1100) << "of those that malloc gives one in 256 begins a page";
  void* const first = pieces.front().get();
  pieces.clear();
  EXPECT_FALSE(isMapped(first));
}

TEST(MappedTables, WhatIsTooLargeIsRefusedAsMallocRefusesIt) {
  const volatile std::size_t bytes = PTRDIFF_MAX;  // the compiler, too, would refuse a constant
  EXPECT_THROW((void)::operator new(bytes), std::bad_alloc);
  EXPECT_EQ(::operator new(bytes, std::nothrow), nullptr);
}

TEST(MappedTables, ThreadsFreeWhatOthersMade) {
  std::vector<std::unique_ptr<char[]>> made(200);
  std::vector<std::thread> threads;
  for (std::size_t t = 0; t < 4; ++t)
    threads.emplace_back([&made, t] {
      for (std::size_t i = t; i < made.size(); i += 4) {
        made[i] = std::make_unique<char[]>((i % 2 == 0) ? kLarge : 100);
        made[i][50] = static_cast<char>(i);
      }
    });
  for (std::thread& thread : threads) thread.join();
  threads.clear();
  for (std::size_t t = 0; t < 4; ++t)
    threads.emplace_back([&made, t] {
      for (std::size_t i = (t + 1) % 4; i < made.size(); i += 4) {
        EXPECT_EQ(made[i][50], static_cast<char>(i));
        made[i].reset();
      }
    });
  for (std::thread& thread : threads) thread.join();
}

}  // namespace
}  // namespace palpate::server
