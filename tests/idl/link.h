// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <chrono>
#include <thread>

#include "palpate/idl/reader.h"
#include "palpate/idl/writer.h"
#include "palpate/testing/test_domain.h"

namespace palpate::dds {

using namespace std::chrono_literals;

// Repeats `attempt` until it says true: DDS delivers soon, not at once.
template <class Attempt>
bool eventually(Attempt attempt) {
  for (int i = 0; i < 2000; ++i) {
    if (attempt()) return true;
    std::this_thread::sleep_for(2ms);
  }
  return false;
}

template <class T>
struct Link {
  Participant participant{palpate::testing::exclusiveDomain()};
  Reader<T> reader{participant};
  Writer<T> writer{participant};

  void connect() {
    ASSERT_TRUE(writer.waitForReaders(1, 5s));
    ASSERT_TRUE(reader.waitForWriters(1, 5s));
  }
};

}  // namespace palpate::dds
