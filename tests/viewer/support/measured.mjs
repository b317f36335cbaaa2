// SPDX-License-Identifier: Apache-2.0
// Times that were asked for, and what depends on them. Tests run on machines with other work, so a time is printed and
// judged only when somebody who has left the machine alone says so: PALPATE_JUDGE_TIMES=1.
import assert from 'node:assert/strict';

const judged = process.env.PALPATE_JUDGE_TIMES === '1';

/** Rounds of a measurement: a fixed number, more of them where it is judged. */
export const rounds = (few, many) => (judged ? many : few);

function say(name, value, wish, unit, kept) {
  console.log(`measured: ${name}: ${value.toFixed(2)} ${unit}, asked for: ${wish} ${unit}`);
  if (judged) assert.ok(kept, `${name}: ${value} ${unit}, asked for: ${wish} ${unit}`);
}

/** Prints what was measured beside what was asked for. `limit` in the unit named. */
export const measured = (name, value, limit, unit) => say(name, value, `at most ${limit}`, unit, value <= limit);

/** The same for what a machine with other work makes smaller. */
export const measuredAtLeast = (name, value, limit, unit) => say(name, value, `at least ${limit}`, unit, value >= limit);

export function median(values) {
  const sorted = [...values].sort((a, b) => a - b);
  return sorted[Math.floor(sorted.length / 2)];
}
