// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <string>

#include "palpate/idl/mismatch.h"
#include "palpate/idl/topic.h"

namespace palpate::dds {

/// Publishes samples of T. The participant must outlive it.
template <class T>
class Writer {
 public:
  using Traits = TopicTraits<T>;
  static constexpr bool kWrites = true;

  /// @throw DdsError naming the topic
  /// Real-time: no.
  explicit Writer(const Participant& participant)
      : topic_(participant),
        entity_(raw::createWriter(participant.handle(), topic_.handle(), Traits::kName, Traits::kProfile)) {}

  /// Sends one sample. Sequences may point into the caller's memory (set _release to false): nothing is kept.
  /// @return false when Cyclone refused it; nothing is thrown
  /// Allocates and locks inside Cyclone (docs/design.md, Threads), so never from the tick; fine in a helper thread.
  /// Threads: any.
  [[nodiscard]] bool write(const T& sample) noexcept {
    return dds_write(entity_.handle(), &sample) == DDS_RETCODE_OK;
  }

  [[nodiscard]] unsigned matched() const noexcept { return raw::matchedReaders(entity_.handle()); }
  /// 0 where nobody reads, else another number with each reader that comes. Real-time: no, it locks.
  [[nodiscard]] std::uint32_t readers() const noexcept { return raw::readersOf(entity_.handle()); }
  /// @return whether at least `count` readers matched within `timeout`
  [[nodiscard]] bool waitForReaders(unsigned count, std::chrono::milliseconds timeout) const noexcept {
    return raw::waitUntilMatched(&raw::matchedReaders, entity_.handle(), count, timeout);
  }
  /// One line when a reader was found whose type or QoS does not fit; else empty.
  [[nodiscard]] std::string mismatch() const { return mismatchOf(entity_.handle(), true); }
  [[nodiscard]] dds_entity_t handle() const noexcept { return entity_.handle(); }

 private:
  Topic<T> topic_;
  Entity entity_;
};

}  // namespace palpate::dds
