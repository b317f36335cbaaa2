// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <dds/dds.h>

#include <memory>

namespace palpate::dds {

/// The rows of the QoS table in docs/design.md, Wire. What is not named has DDS's default, so that endpoints of others
/// match: no deadline, no liveliness.
enum class QosProfile {
  kServo,    ///< 1 kHz, keep last 1: writers offer reliable, readers ask for best effort
  kField,    ///< best effort, keep last 1
  kLatched,  ///< reliable, transient local, keep last 1: late readers get the newest
  kRequest,  ///< reliable, keep last 16
  kAnswer    ///< reliable, keep last 16, transient local: late readers get the newest
};

/// Requests and answers of one server that are kept until they are taken.
inline constexpr int kQueuedRequests = 16;

/// The most instances (tool or organ ids) that one best-effort reader keeps: a client that invents ids cannot fill the
/// server's memory. Reliable readers have no such limit, since Cyclone's receive thread would wait for them: what they
/// read has no key, or a filter bounds the keys (docs/decisions/wire_limits.md).
inline constexpr int kMaxInstances = 1024;

struct QosDeleter {
  void operator()(dds_qos_t* qos) const noexcept { dds_delete_qos(qos); }
};
using QosPtr = std::unique_ptr<dds_qos_t, QosDeleter>;

/// Which end of a topic a QoS is for. Best-effort readers also get bounded storage.
enum class Endpoint {
  kWriter,
  kReader,
  kTap  ///< a reader that keeps nothing: best effort and volatile whatever the row says, so every writer matches
};

/// A new QoS object.
/// Real-time: no.
[[nodiscard]] QosPtr makeQos(QosProfile profile, Endpoint endpoint);

}  // namespace palpate::dds
