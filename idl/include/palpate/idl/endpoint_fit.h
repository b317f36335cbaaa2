// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <dds/dds.h>

#include <string>

namespace palpate::dds {

/// The QoS policies by which a writer and a reader do not match, by their names in the DDS specification, comma-separated;
/// empty when none is in the way. Resource limits, history and the like never are.
/// Real-time: no.
[[nodiscard]] std::string policiesInTheWay(const dds_qos_t* writer, const dds_qos_t* reader);

}  // namespace palpate::dds
