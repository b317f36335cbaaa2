/* SPDX-License-Identifier: Apache-2.0 */
#ifndef PALPATE_HAPTIC_H
#define PALPATE_HAPTIC_H

/*
 * palpate/haptic/haptic_tool.h for C (C99): sends the tool's pose, reads the force on it. That header documents what each
 * call does, the watchdog, the bounds and the threads (one thread sends and reads).
 * SI units; the world frame is that of the organ's mesh. No call throws or ends the process.
 */

#include <stddef.h>
#include <stdint.h>

#include "palpate_haptic_flags.h" /* PALPATE_HAPTIC_FLAG_*, made from palpate.idl */

#if defined(__GNUC__)
#define PALPATE_HAPTIC_C_API __attribute__((visibility("default")))
#else
#define PALPATE_HAPTIC_C_API
#endif

#ifdef __cplusplus
extern "C" {
#endif

/* What a call returns. */
enum {
  PALPATE_HAPTIC_OK = 0,
  PALPATE_HAPTIC_NO_ANSWER = 1,         /* no force came yet, or none in time for 50 ms: the force is zero */
  PALPATE_HAPTIC_INVALID_ARGUMENT = -1, /* a null pointer, or a number out of its range */
  PALPATE_HAPTIC_SEND_FAILED = -2,      /* DDS refused the pose, or no server of the organ is known */
  PALPATE_HAPTIC_NO_SERVER = -3         /* no server within the time */
};

/* Values of palpate_haptic_force.state. */
enum { PALPATE_HAPTIC_FREE = 0, PALPATE_HAPTIC_STICK = 1, PALPATE_HAPTIC_SLIDE = 2 };

typedef struct palpate_haptic palpate_haptic; /* one tool of one server */

#define PALPATE_HAPTIC_ANY_SERVER 0xFFFFFFFFu
#define PALPATE_HAPTIC_ANY_ORGAN (-1)

typedef struct palpate_haptic_options {
  uint32_t domain;    /* DDS domain, 0 to 230 */
  uint32_t server_id; /* the server; PALPATE_HAPTIC_ANY_SERVER: the first that answers */
  uint32_t tool_id;   /* 0 to 3 */
  double
      force_limit; /* largest that the device renders, N, 0.01 to 50: set it, it has no default. The server's applies too */
  double max_extrapolation; /* m, 0 to 0.05 */
  int receive_priority;     /* SCHED_FIFO, 1 to 99; 0: unchanged */
  const char* device;       /* as in palpate-server --device; null: none said */
  int64_t
      organ_id; /* the server of this organ, 0 to 4294967295; PALPATE_HAPTIC_ANY_ORGAN: of any. Until its status has come no pose goes
                       out: palpate_haptic_wait_for_server waits for it */
  const char*
      security; /* folder with the identity of a driver (palpate-security issue driver NAME), where topics are signed and encrypted;
                   null: they are not */
} palpate_haptic_options;

typedef struct palpate_haptic_force {
  double force[3];    /* on the tool, N: what the device renders */
  double anchor[3];   /* rest position of the touched point, m */
  double proxy[3];    /* its current position, m */
  double age_s;       /* time since the newest answer, s; infinity before the first */
  double gain;        /* the watchdog's gain, 0 to 1, already in force */
  uint64_t pose_seq;  /* the answered pose; 0 before the first answer */
  uint32_t flags;     /* PALPATE_HAPTIC_FLAG_* */
  uint32_t state;     /* PALPATE_HAPTIC_FREE, _STICK, _SLIDE */
  uint32_t server_id; /* of the server whose force it is */
  uint64_t
      session; /* of the run of that server; another one: another server has taken over; 0 before the first answer */
} palpate_haptic_force;

/* Fills in the defaults; force_limit has none and is 0, which palpate_haptic_open refuses. Null is ignored. */
PALPATE_HAPTIC_C_API void palpate_haptic_default_options(palpate_haptic_options* options);

/* Joins the domain. On failure returns null and writes one line to `error` (cut to
 * error_size, always terminated; may be null). */
PALPATE_HAPTIC_C_API palpate_haptic* palpate_haptic_open(const palpate_haptic_options* options, char* error,
                                                         size_t error_size);
/* Null is ignored. */
PALPATE_HAPTIC_C_API void palpate_haptic_close(palpate_haptic* tool);

/* PALPATE_HAPTIC_OK once a server takes poses and sends forces; PALPATE_HAPTIC_NO_SERVER after `seconds` (0 to 3600)
 * without one. */
PALPATE_HAPTIC_C_API int palpate_haptic_wait_for_server(const palpate_haptic* tool, double seconds);

/* Sends the current pose. orientation null: no rotation. */
PALPATE_HAPTIC_C_API int palpate_haptic_send(palpate_haptic* tool, const double position[3],
                                             const double orientation[4], uint32_t buttons);

/* The newest force, held until the next answer. PALPATE_HAPTIC_OK or PALPATE_HAPTIC_NO_ANSWER; `out` is filled in both cases. */
PALPATE_HAPTIC_C_API int palpate_haptic_read(palpate_haptic* tool, palpate_haptic_force* out);

/* The same, extrapolated to the tool's current position. */
PALPATE_HAPTIC_C_API int palpate_haptic_read_at(palpate_haptic* tool, const double position[3],
                                                palpate_haptic_force* out);

/* Forces of other servers for this tool that were left out so far; 0 for null. */
PALPATE_HAPTIC_C_API uint64_t palpate_haptic_left_out(const palpate_haptic* tool);

/* Reads whose newest answer was ignored, since it arrived more than 50 ms after its pose was sent; 0 for null. */
PALPATE_HAPTIC_C_API uint64_t palpate_haptic_too_late(const palpate_haptic* tool);

/* How near the tip's centre came to the organ at rest, m: 0 once it touched it; infinity before the first answer, and for null. */
PALPATE_HAPTIC_C_API double palpate_haptic_nearest(const palpate_haptic* tool);

/* The tip radius (m) and the force limit (N) from the server's status; 0 until it has come, or for null. */
PALPATE_HAPTIC_C_API double palpate_haptic_tip_radius(const palpate_haptic* tool);
PALPATE_HAPTIC_C_API double palpate_haptic_server_force_limit(const palpate_haptic* tool);

/* One line for who runs the driver, from 30 days before the identity in palpate_haptic_options.security ends; else empty. Cut to
 * `size`, always terminated. */
PALPATE_HAPTIC_C_API void palpate_haptic_security_warning(const palpate_haptic* tool, char* text,
                                                          size_t size);

/* One line about a code; never null. */
PALPATE_HAPTIC_C_API const char* palpate_haptic_error_text(int code);

#ifdef __cplusplus
}
#endif

#endif
