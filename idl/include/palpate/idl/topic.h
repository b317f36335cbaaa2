// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "palpate/idl/participant.h"
#include "palpate/idl/raw.h"
#include "palpate/idl/topics.h"

namespace palpate::dds {

/// The topic that carries T, as TopicTraits<T> names it. May be created several times on one participant.
template <class T>
class Topic {
 public:
  using Traits = TopicTraits<T>;

  /// @throw DdsError naming the topic
  /// Real-time: no.
  explicit Topic(const Participant& participant)
      : entity_(raw::createTopic(participant.handle(), Traits::descriptor(), Traits::kName)) {}

  [[nodiscard]] dds_entity_t handle() const noexcept { return entity_.handle(); }

 private:
  Entity entity_;
};

}  // namespace palpate::dds
