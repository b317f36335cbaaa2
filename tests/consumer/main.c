/* SPDX-License-Identifier: Apache-2.0 */
/* The C interface as installed: opens, sends, reads without a server, and is refused what it must be. */
#include <palpate_haptic.h>
#include <stdio.h>
#include <string.h>

static int expect(int holds, const char* what) {
  if (!holds) fprintf(stderr, "failed: %s\n", what);
  return holds ? 0 : 1;
}

int main(void) {
  palpate_haptic_options options;
  palpate_haptic_force force;
  char error[200];
  const double position[3] = {0.0, 0.0, 0.1};
  int failures = 0;

  palpate_haptic_default_options(&options);
  options.tool_id = 7;
  failures += expect(palpate_haptic_open(&options, error, sizeof error) == NULL, "tool id 7 is refused");
  failures += expect(strcmp(error, "tool id is 7, expected 0 to 3") == 0, "and said why");

  options.tool_id = 0;
  options.domain = 217;
  options.force_limit = 3.3;
  palpate_haptic* tool = palpate_haptic_open(&options, error, sizeof error);
  if (tool == NULL) {
    fprintf(stderr, "%s\n", error);
    return 1;
  }
  failures += expect(palpate_haptic_wait_for_server(tool, 0.1) == PALPATE_HAPTIC_NO_SERVER, "no server");
  failures += expect(palpate_haptic_send(tool, position, NULL, 0) == PALPATE_HAPTIC_OK, "a pose is sent");
  failures += expect(palpate_haptic_read_at(tool, position, &force) == PALPATE_HAPTIC_NO_ANSWER, "no answer");
  failures += expect(force.force[0] == 0.0 && force.force[1] == 0.0 && force.force[2] == 0.0, "no force");
  failures += expect(palpate_haptic_read(NULL, &force) == PALPATE_HAPTIC_INVALID_ARGUMENT, "null is refused");
  palpate_haptic_close(tool);
  printf("%s\n", palpate_haptic_error_text(PALPATE_HAPTIC_OK));
  return failures;
}
