// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <dds/dds.h>

#include <string>
#include <vector>

#include "palpate/idl/entity.h"
#include "palpate/idl/participant.h"

namespace palpate::dds {

/// A process of the domain, as its participant says it. Printable; empty where another DDS than Cyclone says nothing.
struct Process {
  std::string name, pid, host;

  /// "palpate-tool (77) on HOST"; empty when nothing is known.
  [[nodiscard]] std::string text() const;
};

/// As a participant's QoS says it. Cyclone says nothing of participants with an identity.
[[nodiscard]] Process processIn(const dds_qos_t* qos);

/// Of a participant that a reader of DCPSParticipant knows. @param[in] participants  that reader
[[nodiscard]] Process processOf(dds_entity_t participants, dds_instance_handle_t participant);

/// Whose writers are. Real-time: no. Threads: one. The participant must outlive it.
class ProcessBook {
 public:
  /// @throw DdsError
  explicit ProcessBook(const Participant& participant);

  /// The process of a writer. @param[in] reader  that matched it
  [[nodiscard]] Process processOf(dds_entity_t reader, dds_instance_handle_t writer) const;

 private:
  Entity participants_;
};

/// Writers that a reader matches now, at most `most`.
[[nodiscard]] std::vector<dds_instance_handle_t> writersOf(dds_entity_t reader, std::size_t most = 64);

}  // namespace palpate::dds
