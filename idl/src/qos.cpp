// SPDX-License-Identifier: Apache-2.0
#include "palpate/idl/qos.h"

namespace palpate::dds {

namespace {

int depthOf(QosProfile profile) noexcept {
  return profile == QosProfile::kRequest || profile == QosProfile::kAnswer ? kQueuedRequests : 1;
}

bool isReliable(QosProfile profile, Endpoint endpoint) noexcept {
  if (endpoint == Endpoint::kTap) return false;
  if (profile == QosProfile::kServo) return endpoint == Endpoint::kWriter;
  return profile != QosProfile::kField;
}

bool isKept(QosProfile profile, Endpoint endpoint) noexcept {
  if (endpoint == Endpoint::kTap) return false;
  return profile == QosProfile::kLatched || profile == QosProfile::kAnswer;
}

}  // namespace

QosPtr makeQos(QosProfile profile, Endpoint endpoint) {
  QosPtr qos(dds_create_qos());
  const int depth = depthOf(profile);
  dds_qset_history(qos.get(), DDS_HISTORY_KEEP_LAST, depth);
  dds_qset_reliability(qos.get(),
                       isReliable(profile, endpoint) ? DDS_RELIABILITY_RELIABLE : DDS_RELIABILITY_BEST_EFFORT,
                       DDS_MSECS(100));
  dds_qset_durability(qos.get(),
                      isKept(profile, endpoint) ? DDS_DURABILITY_TRANSIENT_LOCAL : DDS_DURABILITY_VOLATILE);
  if (isKept(profile, endpoint))
    dds_qset_durability_service(qos.get(), 0, DDS_HISTORY_KEEP_LAST, 1, DDS_LENGTH_UNLIMITED,
                                DDS_LENGTH_UNLIMITED, DDS_LENGTH_UNLIMITED);
  // A reliable reader that refuses a sample makes Cyclone's receive thread wait until it takes it, and all else with it.
  if (endpoint != Endpoint::kWriter && !isReliable(profile, endpoint))
    dds_qset_resource_limits(qos.get(), kMaxInstances, kMaxInstances, depth);
  return qos;
}

}  // namespace palpate::dds
