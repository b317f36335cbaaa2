/* SPDX-License-Identifier: Apache-2.0 */
/* A program that does everything wrong, from palpate.idl alone, with DDS's default QoS.

       hostile_peer DOMAIN KIND|all SECONDS X Y Z

   Does each kind of wrong for so long and prints how often it did. X Y Z: where the tip's centre just touches the organ
   from above, m. The server answers tool 1 and not tool 3; tool 0 belongs to somebody who behaves. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "peer.h"

typedef struct {
  palpate_ServerStatus server;
  dds_entity_t participant, poses, forces, requests, statuses, announcements;
  double touch[3];
} Peer;

/* A pose of tool 1 that presses 1 mm deep, and nothing wrong with it yet. */
static palpate_ToolPose goodPose(const Peer* p, uint64_t i) {
  palpate_ToolPose pose;
  memset(&pose, 0, sizeof pose);
  pose.server_id = p->server.server_id;
  pose.tool_id = 1;
  pose.seq = (uint64_t)now() + i;
  pose.stamp_ns = now();
  memcpy(pose.position, p->touch, sizeof pose.position);
  pose.position[2] -= 0.001;
  pose.orientation[3] = 1.0;
  return pose;
}

static void send(const Peer* p, const palpate_ToolPose* pose) {
  dds_write(p->poses, pose);
}

static double garbage(uint64_t i) {
  const double list[] = {NAN, INFINITY, -INFINITY, 1e300, -1e300, 1e-310, 1e4, -0.0};
  return list[i % 8];
}

static int64_t wrongStamp(uint64_t i) {
  const int64_t list[] = {INT64_MIN, -1, 0, INT64_MAX};
  return list[i % 4];
}

#define POSE_KIND(name, change)                 \
  static void name(const Peer* p, uint64_t i) { \
    palpate_ToolPose pose = goodPose(p, i);     \
    change;                                     \
    send(p, &pose);                             \
  }
POSE_KIND(positionNan, pose.position[i % 3] = NAN)
POSE_KIND(positionInfinite, pose.position[i % 3] = i % 2 ? INFINITY : -INFINITY)
POSE_KIND(positionHuge, pose.position[i % 3] = i % 2 ? 1e300 : -999.0)
POSE_KIND(quaternionNan, pose.orientation[i % 4] = NAN)
POSE_KIND(quaternionNotUnit, pose.orientation[3] = i % 2 ? 0.0 : 1e200)
POSE_KIND(seqBackwards, pose.seq = UINT64_MAX - i)
POSE_KIND(seqRepeated, pose.seq = i / 7 % 2 ? 0 : 42)
POSE_KIND(stampWrong, pose.stamp_ns = wrongStamp(i))
POSE_KIND(toolUnknown, pose.tool_id = i % 2 ? UINT32_MAX : 4)
POSE_KIND(toolNotConfigured, pose.tool_id = 3)
POSE_KIND(serverWrong, pose.server_id += 1 + (uint32_t)(i % 3))
POSE_KIND(serverAny, pose.server_id = palpate_SERVER_ANY)
POSE_KIND(velocityNan, pose.has_velocity = true; pose.velocity[i % 3] = garbage(i))
POSE_KIND(jumps, pose.position[i % 3] += i % 2 ? 0.3 : -0.3)
POSE_KIND(deepAtOnce, pose.position[2] -= i / 50 % 2 ? 0.05 : -0.02)
POSE_KIND(buttonsGarbage, pose.buttons = (uint32_t)(i * 2654435761u))
POSE_KIND(secondPublisher, pose.tool_id = 0)
POSE_KIND(secondPublisherGarbage, pose.tool_id = 0; pose.position[i % 3] = garbage(i))
POSE_KIND(floodOfTools, pose.tool_id = (uint32_t)i)
POSE_KIND(floodOfServers, pose.server_id = (uint32_t)i; pose.tool_id = (uint32_t)(i % 4))

static void manyPublishers(const Peer* p, uint64_t i) {
  Peer another = *p;
  another.poses =
      join(&dds_create_writer, p->participant, &palpate_ToolPose_desc, "palpate/tool/measured_cp", NULL);
  for (uint64_t k = 0; k < 5; ++k) secondPublisher(&another, i + k);
  dds_delete(another.poses);
}

static void disposes(const Peer* p, uint64_t i) {
  palpate_ToolPose pose = goodPose(p, i);
  pose.tool_id = (uint32_t)(i % 2 ? i : 0);
  dds_dispose(p->poses, &pose);
}

static palpate_ParameterRequest question(const Peer* p, uint64_t id) {
  palpate_ParameterRequest request;
  memset(&request, 0, sizeof request);
  request.server_id = p->server.server_id;
  request.request_id = id;
  return request;
}

static void setAll(palpate_ParameterRequest* request, double value) {
  request->youngs_modulus = request->friction = request->coupling_stiffness = value;
  request->coupling_damping = request->force_limit = request->force_rate_limit = value;
}

static void requestRepeated(const Peer* p, uint64_t i) {
  palpate_ParameterRequest request = question(p, i / 10 % 2 ? 0 : 7);
  request.fields = palpate_PARAMETER_FRICTION;
  request.friction = 0.1 * (double)(i % 5);
  dds_write(p->requests, &request);
}

static void requestUnknownBits(const Peer* p, uint64_t i) {
  palpate_ParameterRequest request = question(p, (uint64_t)now());
  request.fields = i % 2 ? UINT32_MAX : 1u << (6 + i % 26);
  dds_write(p->requests, &request);
}

static void requestGarbage(const Peer* p, uint64_t i) {
  palpate_ParameterRequest request = question(p, (uint64_t)now());
  request.fields = 1u << (i / 8 % 6);
  setAll(&request, garbage(i));
  dds_write(p->requests, &request);
}

/* What anybody may ask for, as stiff and as strong as he can. */
static void requestExtremes(const Peer* p, uint64_t i) {
  const double list[] = {1e9, 50.0, 1e5, 1e6, 100.0, 2.0};
  palpate_ParameterRequest request = question(p, (uint64_t)now());
  request.fields = 1u << (i % 6);
  setAll(&request, list[i / 6 % 6]);
  dds_write(p->requests, &request);
}

static void requestsToOthers(const Peer* p, uint64_t i) {
  palpate_ParameterRequest request = question(p, i + 1);
  request.server_id = p->server.server_id + 1 + (uint32_t)(i % 1100);
  dds_write(p->requests, &request);
}

static void requestFlood(const Peer* p, uint64_t i) {
  const palpate_ParameterRequest request = question(p, i + 1);
  dds_write(p->requests, &request);
}

/* Another server's answer to tool 0: from one that says so, or from one that pretends to be the same. */
static void rivalForces(const Peer* p, uint64_t i) {
  palpate_ToolForce force;
  memset(&force, 0, sizeof force);
  force.server_id = p->server.server_id;
  force.session = i % 2 ? p->server.session : p->server.session + 1;
  force.seq = i;
  force.pose_seq = (uint64_t)now();
  for (int k = 0; k < 3; ++k) force.force[k] = i % 4 < 2 ? 1000.0 : NAN;
  dds_write(p->forces, &force);
}

static void rivalStatus(const Peer* p, uint64_t i) {
  palpate_ServerStatus status = p->server;
  if (i % 2) status.session += i;
  status.state = i % 3 ? palpate_SERVER_RUNNING : palpate_SERVER_STOPPING;
  status.tip_radius[i % 4] = garbage(i);
  status.force_limit = garbage(i + 3);
  memset(status.message, 'x', sizeof status.message - 1);
  memset(status.model_id, '%', sizeof status.model_id - 1);
  dds_write(p->statuses, &status);
}

static void statusDisposes(const Peer* p, uint64_t i) {
  palpate_ServerStatus status = p->server;
  status.session += i + 1;
  dds_dispose(p->statuses, &status);
}

static palpate_ToolAnnouncement word(const Peer* p, uint64_t i) {
  palpate_ToolAnnouncement said;
  memset(&said, 0, sizeof said);
  said.server_id = i % 2 ? p->server.server_id : palpate_SERVER_ANY;
  said.tool_id = (uint32_t)(i % 4);
  said.device_force_limit = 0.01;
  return said;
}

static void announcementGarbage(const Peer* p, uint64_t i) {
  palpate_ToolAnnouncement said = word(p, i);
  memset(said.device, i % 3 ? '\033' : '%', sizeof said.device - 1);
  said.device_force_limit = garbage(i);
  said.has_tip_radius = i % 2 != 0;
  said.tip_radius = garbage(i + 1);
  said.fields = i % 5 ? 1u << (i % 32) : UINT32_MAX;
  said.values.friction = said.values.force_limit = garbage(i + 2);
  dds_write(p->announcements, &said);
}

static void announcementFlood(const Peer* p, uint64_t i) {
  const palpate_ToolAnnouncement said = word(p, i);
  dds_write(p->announcements, &said);
}

typedef struct {
  const char* name;
  void (*act)(const Peer*, uint64_t);
  int hz;
} Kind;

static const Kind kKinds[] = {
    {"position-nan", &positionNan, 1000},
    {"position-infinite", &positionInfinite, 1000},
    {"position-huge", &positionHuge, 1000},
    {"quaternion-nan", &quaternionNan, 1000},
    {"quaternion-not-unit", &quaternionNotUnit, 1000},
    {"seq-backwards", &seqBackwards, 1000},
    {"seq-repeated", &seqRepeated, 1000},
    {"stamp-wrong", &stampWrong, 1000},
    {"tool-unknown", &toolUnknown, 1000},
    {"tool-not-configured", &toolNotConfigured, 1000},
    {"server-wrong", &serverWrong, 1000},
    {"server-any", &serverAny, 1000},
    {"velocity-nan", &velocityNan, 1000},
    {"jumps", &jumps, 1000},
    {"deep-at-once", &deepAtOnce, 1000},
    {"buttons-garbage", &buttonsGarbage, 1000},
    {"second-publisher", &secondPublisher, 1000},
    {"second-publisher-garbage", &secondPublisherGarbage, 1000},
    {"many-publishers", &manyPublishers, 100},
    {"disposes", &disposes, 1000},
    {"request-repeated", &requestRepeated, 100},
    {"request-unknown-bits", &requestUnknownBits, 100},
    {"request-garbage", &requestGarbage, 100},
    {"request-extremes", &requestExtremes, 100},
    {"rival-forces", &rivalForces, 2000},
    {"rival-status", &rivalStatus, 200},
    {"status-disposes", &statusDisposes, 4000},
    {"announcement-garbage", &announcementGarbage, 1000},
    {"flood-of-announcements", &announcementFlood, 4000},
    {"flood-of-poses", &buttonsGarbage, 8000},
    {"flood-of-tools", &floodOfTools, 8000},
    {"flood-of-servers", &floodOfServers, 8000},
    {"flood-of-requests", &requestFlood, 4000},
    {"flood-of-requests-to-others", &requestsToOthers, 4000},
};
enum { kKindCount = sizeof kKinds / sizeof kKinds[0] };

static uint64_t act(const Peer* p, const Kind* kind, double seconds) {
  const int64_t begin = now(), end = begin + (int64_t)(seconds * 1e9), period = DDS_NSECS_IN_SEC / kind->hz;
  uint64_t i = 0;
  for (int64_t due = begin; due < end; due += period, ++i) {
    if (due - now() > DDS_USECS(500)) dds_sleepfor(due - now()); /* else in a burst */
    kind->act(p, i);
  }
  return i;
}

int main(int argc, char** argv) {
  if (argc != 7) return 2;
  Peer p;
  p.participant = dds_create_participant((dds_domainid_t)atoi(argv[1]), NULL, NULL);
  if (p.participant < 0 || !findServer(p.participant, &p.server)) return 3;
  for (int k = 0; k < 3; ++k) p.touch[k] = atof(argv[4 + k]);
  p.poses = join(&dds_create_writer, p.participant, &palpate_ToolPose_desc, "palpate/tool/measured_cp", NULL);
  p.forces = join(&dds_create_writer, p.participant, &palpate_ToolForce_desc, "palpate/tool/servo_cf", NULL);
  p.requests = join(&dds_create_writer, p.participant, &palpate_ParameterRequest_desc,
                    "palpate/server/parameter_request", NULL);
  p.statuses =
      join(&dds_create_writer, p.participant, &palpate_ServerStatus_desc, "palpate/server/status", NULL);
  p.announcements = join(&dds_create_writer, p.participant, &palpate_ToolAnnouncement_desc,
                         "palpate/tool/announcement", NULL);
  dds_sleepfor(DDS_MSECS(200)); /* until they have matched */
  for (int i = 0; i < kKindCount; ++i) {
    if (strcmp(argv[2], "all") != 0 && strcmp(argv[2], kKinds[i].name) != 0) continue;
    printf("%s: %llu\n", kKinds[i].name, (unsigned long long)act(&p, &kKinds[i], atof(argv[3])));
    fflush(stdout);
  }
  dds_delete(p.participant);
  return 0;
}
