/* SPDX-License-Identifier: Apache-2.0 */
/* A tool from palpate.idl alone, in C, with Cyclone DDS and its default QoS: finds the organ, presses its top 3 mm deep
   within a second, and prints the largest force. README.md says how to build it by itself. */
#include <dds/dds.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "palpate.h" /* idlc palpate.idl */

static const double kDepth = 0.003; /* m */
enum { kPoses = 1000 };             /* one per ms */

typedef struct {
  dds_entity_t status, surface, poses, forces;
} Endpoints;

static void sleepMs(long ms) {
  const struct timespec time = {ms / 1000, ms % 1000 * 1000000};
  nanosleep(&time, NULL);
}

static dds_entity_t topic(dds_entity_t participant, const dds_topic_descriptor_t* type, const char* name) {
  return dds_create_topic(participant, type, name, NULL, NULL);
}

static Endpoints join(dds_entity_t participant) {
  const Endpoints e = {
      dds_create_reader(participant, topic(participant, &palpate_ServerStatus_desc, "palpate/server/status"),
                        NULL, NULL),
      dds_create_reader(participant, topic(participant, &palpate_SurfaceMesh_desc, "palpate/organ/surface"),
                        NULL, NULL),
      dds_create_writer(participant, topic(participant, &palpate_ToolPose_desc, "palpate/tool/measured_cp"),
                        NULL, NULL),
      dds_create_reader(participant, topic(participant, &palpate_ToolForce_desc, "palpate/tool/servo_cf"),
                        NULL, NULL)};
  return e;
}

/* Waits for the status of a running server. Returns 0 when none came within 10 s. */
static int findServer(dds_entity_t reader, palpate_ServerStatus* status) {
  for (int i = 0; i < 1000; ++i, sleepMs(10)) {
    void* sample = status;
    dds_sample_info_t info;
    if (dds_take(reader, &sample, &info, 1, 1) == 1 && info.valid_data &&
        status->state == palpate_SERVER_RUNNING)
      return 1;
  }
  return 0;
}

/* The accessible node of that server's organ with the largest z. Returns 0 when no surface came within 10 s. */
static int findTop(dds_entity_t reader, const palpate_ServerStatus* status, double top[3]) {
  for (int i = 0; i < 1000; ++i, sleepMs(10)) {
    void* samples[1] = {NULL};
    dds_sample_info_t info;
    if (dds_take(reader, samples, &info, 1, 1) != 1) continue;
    const palpate_SurfaceMesh* mesh = samples[0];
    int found = 0;
    if (info.valid_data && mesh->session == status->session &&
        mesh->positions._length == 3 * mesh->accessible._length) {
      for (uint32_t node = 0; node < mesh->accessible._length; ++node) {
        const double* X = mesh->positions._buffer + 3 * node;
        if (!mesh->accessible._buffer[node] || (found && X[2] <= top[2])) continue;
        memcpy(top, X, 3 * sizeof top[0]);
        found = 1;
      }
    }
    dds_return_loan(reader, samples, 1);
    if (found) return 1;
  }
  return 0;
}

/* The newest answer of that run of the server to one of our poses. */
static int takeForce(dds_entity_t reader, const palpate_ServerStatus* status, uint64_t first_seq,
                     palpate_ToolForce* force) {
  int taken = 0;
  palpate_ToolForce one;
  void* sample = &one;
  dds_sample_info_t info;
  while (dds_take(reader, &sample, &info, 1, 1) == 1) {
    if (!info.valid_data || one.session != status->session || one.tool_id != 0 || one.pose_seq < first_seq)
      continue;
    *force = one;
    taken = 1;
  }
  return taken;
}

static void press(const Endpoints* e, const palpate_ServerStatus* status, const double top[3]) {
  palpate_ToolPose pose;
  memset(&pose, 0, sizeof pose);
  pose.server_id = status->server_id;
  pose.orientation[3] = 1.0;
  pose.seq = (uint64_t)dds_time(); /* a sender that starts again stays ahead of its former poses */
  const uint64_t first_seq = pose.seq + 1;
  palpate_ToolForce force;
  double largest = 0.0;
  int answers = 0;
  for (int i = 0; i < kPoses; ++i, sleepMs(1)) {
    const double height = 0.001 - (0.001 + kDepth) * i / kPoses; /* of the tip's lowest point over the top */
    ++pose.seq;
    pose.stamp_ns = dds_time();
    pose.position[0] = top[0];
    pose.position[1] = top[1];
    pose.position[2] = top[2] + status->tip_radius[0] + height;
    dds_write(e->poses, &pose);
    if (!takeForce(e->forces, status, first_seq, &force)) continue;
    ++answers;
    largest = fmax(largest, sqrt(force.force[0] * force.force[0] + force.force[1] * force.force[1] +
                                 force.force[2] * force.force[2]));
  }
  printf("largest force %.3f N, %d answers to %d poses\n", largest, answers, kPoses);
}

int main(int argc, char** argv) {
  const dds_entity_t participant =
      dds_create_participant(argc > 1 ? (dds_domainid_t)atoi(argv[1]) : 0, NULL, NULL);
  const Endpoints e = join(participant);
  palpate_ServerStatus status;
  double top[3] = {0.0, 0.0, 0.0};
  int ok = 0;
  if (participant < 0 || e.status < 0 || e.surface < 0 || e.poses < 0 || e.forces < 0) {
    fprintf(stderr, "DDS refused to start\n");
  } else if (!findServer(e.status, &status)) {
    fprintf(stderr, "no palpate-server within 10 s\n");
  } else if (!findTop(e.surface, &status, top)) {
    fprintf(stderr, "no surface of server %u within 10 s\n", (unsigned)status.server_id);
  } else {
    press(&e, &status, top);
    ok = 1;
  }
  dds_delete(participant);
  return ok ? 0 : 1;
}
