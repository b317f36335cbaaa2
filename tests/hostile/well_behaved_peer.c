/* SPDX-License-Identifier: Apache-2.0 */
/* A tool that behaves, from palpate.idl alone: it presses and lifts off at 1 kHz, holds on to the first server that answers it,
   and counts its answers.

       well_behaved_peer DOMAIN SECONDS X Y Z FORCE_LIMIT

   X Y Z: where the tip's centre just touches the organ from above, m. Prints one line "SECOND answers N" per second, then
   "largest F N, in contact C, not finite M". */
#include <math.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "peer.h"

enum { kMostSeconds = 600 };

static palpate_ServerStatus server;
static uint64_t first_seq;
static _Atomic uint64_t last_seq;
static dds_instance_handle_t answerer; /* the writer of the first answer */
static _Atomic int answers[kMostSeconds];
static int64_t begin_ns;
static double largest;
static int in_contact, not_finite;

static int isOurs(const palpate_ToolForce* force, dds_instance_handle_t writer) {
  if (force->tool_id != 0 || force->session != server.session || force->server_id != server.server_id)
    return 0;
  if (force->pose_seq < first_seq || force->pose_seq > last_seq) return 0;
  if (answerer == 0) answerer = writer;
  return writer == answerer;
}

static void onForce(dds_entity_t reader, void* context) {
  (void)context;
  palpate_ToolForce force;
  void* sample = &force;
  dds_sample_info_t info;
  while (dds_take(reader, &sample, &info, 1, 1) == 1) {
    if (!info.valid_data || !isOurs(&force, info.publication_handle)) continue;
    const double size = sqrt(force.force[0] * force.force[0] + force.force[1] * force.force[1] +
                             force.force[2] * force.force[2]);
    const int64_t second = (now() - begin_ns) / DDS_NSECS_IN_SEC;
    if (second >= 0 && second < kMostSeconds) ++answers[second];
    if (!isfinite(size)) ++not_finite;
    if (size > largest) largest = size;
    if (force.flags & palpate_FLAG_IN_CONTACT) ++in_contact;
  }
}

/* 2 mm deep and 1 mm above, once a second. */
static double heightAt(int64_t time_ns) {
  const double phase = 2.0 * 3.14159265358979 * (double)time_ns * 1e-9;
  return -0.0005 + 0.0015 * cos(phase);
}

static void play(dds_entity_t poses, int seconds, const double touch[3]) {
  palpate_ToolPose pose;
  memset(&pose, 0, sizeof pose);
  pose.server_id = server.server_id;
  pose.orientation[3] = 1.0;
  pose.seq = first_seq - 1;
  for (int i = 0; i < 1000 * seconds; ++i) {
    const int64_t due = begin_ns + DDS_MSECS(1) * i;
    const int64_t wait = due - now();
    if (wait > 0) dds_sleepfor(wait);
    memcpy(pose.position, touch, sizeof pose.position);
    pose.position[2] += heightAt(DDS_MSECS(1) * i);
    last_seq = ++pose.seq;
    pose.stamp_ns = now();
    dds_write(poses, &pose);
  }
}

int main(int argc, char** argv) {
  if (argc != 7) return 2;
  const int seconds = atoi(argv[2]);
  const double touch[3] = {atof(argv[3]), atof(argv[4]), atof(argv[5])};
  const dds_entity_t participant = dds_create_participant((dds_domainid_t)atoi(argv[1]), NULL, NULL);
  if (seconds > kMostSeconds || participant < 0 || !findServer(participant, &server)) return 3;
  first_seq = (uint64_t)now();
  last_seq = first_seq;
  dds_listener_t* listener = dds_create_listener(NULL);
  dds_lset_data_available(listener, &onForce);
  const dds_entity_t poses =
      join(&dds_create_writer, participant, &palpate_ToolPose_desc, "palpate/tool/measured_cp", NULL);
  const dds_entity_t forces =
      join(&dds_create_reader, participant, &palpate_ToolForce_desc, "palpate/tool/servo_cf", listener);
  dds_sleepfor(DDS_MSECS(500)); /* until both have matched */
  begin_ns = now();
  play(poses, seconds, touch);
  dds_sleepfor(DDS_MSECS(20));
  dds_delete(forces); /* no callback any more */
  for (int second = 0; second < seconds; ++second) printf("%d answers %d\n", second, answers[second]);
  printf("largest %.6f N, in contact %d, not finite %d\n", largest, in_contact, not_finite);
  dds_delete(participant);
  return largest <= atof(argv[6]) && not_finite == 0 ? 0 : 1;
}
