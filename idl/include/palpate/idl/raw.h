// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
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
/// @param[in] endpoint     kReader or kTap
/// @param[in] ignores_own  leave out samples of the same participant
[[nodiscard]] dds_entity_t createReader(dds_entity_t participant, dds_entity_t topic, const char* name,
                                        QosProfile profile, const dds_listener_t* listener,
                                        Endpoint endpoint = Endpoint::kReader, bool ignores_own = false);

/// Number of matched counterparts of a writer or reader, 0 on error.
/// Real-time: no, it locks.
[[nodiscard]] unsigned matchedReaders(dds_entity_t writer) noexcept;
[[nodiscard]] unsigned matchedWriters(dds_entity_t reader) noexcept;
/// 0 where no reader is matched, else how many ever were: another number with each that comes. Real-time: no, it locks.
[[nodiscard]] std::uint32_t readersOf(dds_entity_t writer) noexcept;

/// 32 hexadecimal digits.
[[nodiscard]] std::string textOf(const dds_guid_t& guid);

/// GUID of the participant of a matched writer, 32 hexadecimal digits; empty when there is no such writer.
[[nodiscard]] std::string participantGuid(dds_entity_t reader, dds_instance_handle_t writer);

/// Looks every few milliseconds until `matched(entity)` reaches `count`. @return whether it did within
/// `timeout`
[[nodiscard]] bool waitUntilMatched(unsigned (*matched)(dds_entity_t) noexcept, dds_entity_t entity,
                                    unsigned count, std::chrono::milliseconds timeout) noexcept;

}  // namespace palpate::dds::raw
