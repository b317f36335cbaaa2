// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <string>

#include "palpate/idl/qos.h"

// What Topic, Writer and Reader share once the type is erased.
namespace palpate::dds::raw {

/// @throw DdsError naming the topic
/// Real-time: no.
[[nodiscard]] dds_entity_t createTopic(dds_entity_t participant, const dds_topic_descriptor_t& descriptor,
                                       const char* name);
[[nodiscard]] dds_entity_t createWriter(dds_entity_t participant, dds_entity_t topic, const char* name,
                                        QosProfile profile);
[[nodiscard]] dds_entity_t createReader(dds_entity_t participant, dds_entity_t topic, const char* name,
                                        QosProfile profile, const dds_listener_t* listener);

/// Number of matched counterparts of a writer or reader, 0 on error.
/// Real-time: no, it locks.
[[nodiscard]] unsigned matchedReaders(dds_entity_t writer) noexcept;
[[nodiscard]] unsigned matchedWriters(dds_entity_t reader) noexcept;

/// One line when a counterpart was found that cannot match, e.g. because its @final type is another version;
/// empty when none was.
[[nodiscard]] std::string mismatchOfWriter(dds_entity_t writer, const char* name);
[[nodiscard]] std::string mismatchOfReader(dds_entity_t reader, const char* name);

/// Looks every few milliseconds until `matched(entity)` reaches `count`. @return whether it did within
/// `timeout`
[[nodiscard]] bool waitUntilMatched(unsigned (*matched)(dds_entity_t) noexcept, dds_entity_t entity,
                                    unsigned count, std::chrono::milliseconds timeout) noexcept;

}  // namespace palpate::dds::raw
