// SPDX-License-Identifier: Apache-2.0
#include "palpate/idl/qos.h"

namespace palpate::dds {

namespace {

int depthOf(QosProfile profile) noexcept {
  return profile == QosProfile::kRequest || profile == QosProfile::kAnswer ? kQueuedRequests : 1;
}

bool isReliable(QosProfile profile) noexcept {
  return profile != QosProfile::kServo && profile != QosProfile::kField;
}

}  // namespace

QosPtr makeQos(QosProfile profile, Endpoint endpoint) {
  QosPtr qos(dds_create_qos());
  const int depth = depthOf(profile);
  dds_qset_history(qos.get(), DDS_HISTORY_KEEP_LAST, depth);
  if (isReliable(profile)) {
    dds_qset_reliability(qos.get(), DDS_RELIABILITY_RELIABLE, DDS_MSECS(100));
    dds_qset_durability(qos.get(), profile == QosProfile::kRequest ? DDS_DURABILITY_VOLATILE
                                                                   : DDS_DURABILITY_TRANSIENT_LOCAL);
    dds_qset_durability_service(qos.get(), 0, DDS_HISTORY_KEEP_LAST, 1, DDS_LENGTH_UNLIMITED,
                                DDS_LENGTH_UNLIMITED, DDS_LENGTH_UNLIMITED);
  } else {
    dds_qset_reliability(qos.get(), DDS_RELIABILITY_BEST_EFFORT, 0);
    dds_qset_durability(qos.get(), DDS_DURABILITY_VOLATILE);
  }
  if (profile == QosProfile::kServo) {
    dds_qset_deadline(qos.get(), DDS_MSECS(5));
    dds_qset_liveliness(qos.get(), DDS_LIVELINESS_AUTOMATIC, DDS_MSECS(50));
  }
  if (endpoint == Endpoint::kReader) dds_qset_resource_limits(qos.get(), kMaxInstances, kMaxInstances, depth);
  return qos;
}

}  // namespace palpate::dds
