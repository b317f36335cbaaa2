/* SPDX-License-Identifier: Apache-2.0 */
/* What both programs of this folder need: palpate.idl, DDS with its default QoS, and a clock. Nothing of palpate's code. */
#ifndef PALPATE_TEST_PEER_H
#define PALPATE_TEST_PEER_H

#include <dds/dds.h>
#include <stdint.h>

#include "palpate.h"

static inline int64_t now(void) {
  return dds_time();
}

/* A writer or reader without any QoS of its own. */
static inline dds_entity_t join(dds_entity_t (*create)(dds_entity_t, dds_entity_t, const dds_qos_t*,
                                                       const dds_listener_t*),
                                dds_entity_t participant, const dds_topic_descriptor_t* type,
                                const char* topic, const dds_listener_t* listener) {
  return create(participant, dds_create_topic(participant, type, topic, NULL, NULL), NULL, listener);
}

/* Waits for the status of a server that runs: whom to talk to. Returns 0 when none came within 10 s. */
static inline int findServer(dds_entity_t participant, palpate_ServerStatus* status) {
  const dds_entity_t reader =
      join(&dds_create_reader, participant, &palpate_ServerStatus_desc, "palpate/server/status", NULL);
  int found = 0;
  for (int i = 0; i < 1000 && !found; ++i) {
    void* sample = status;
    dds_sample_info_t info;
    found = dds_take(reader, &sample, &info, 1, 1) == 1 && info.valid_data &&
            status->state == palpate_SERVER_RUNNING;
    if (!found) dds_sleepfor(DDS_MSECS(10));
  }
  dds_delete(reader);
  return found;
}

#endif
