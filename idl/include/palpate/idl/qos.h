// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <dds/dds.h>

#include <memory>

namespace palpate::dds {

/// The three rows of the QoS table in docs/design.md, Wire, and a pair for questions.
enum class QosProfile {
  kServo,    ///< 1 kHz: best effort, keep last 1, deadline 5 ms, liveliness automatic 50 ms
  kField,    ///< best effort, keep last 1
  kLatched,  ///< reliable, transient local, keep last 1: late readers get the newest
  kRequest,  ///< reliable, keep last 16
  kAnswer    ///< reliable, keep last 16, transient local: late readers get the newest
};

/// Requests and answers of one server that are kept until they are taken.
inline constexpr int kQueuedRequests = 16;

/// The most instances (tool, organ or server ids) that one reader keeps: a client that invents ids cannot
/// fill the server's memory.
inline constexpr int kMaxInstances = 1024;

struct QosDeleter {
  void operator()(dds_qos_t* qos) const noexcept { dds_delete_qos(qos); }
};
using QosPtr = std::unique_ptr<dds_qos_t, QosDeleter>;

/// Which end of a topic a QoS is for: readers also get bounded storage.
enum class Endpoint { kWriter, kReader };

/// A new QoS object.
/// Real-time: no.
[[nodiscard]] QosPtr makeQos(QosProfile profile, Endpoint endpoint);

}  // namespace palpate::dds
