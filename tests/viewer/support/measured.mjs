// SPDX-License-Identifier: Apache-2.0
// Times that were asked for. Tests run on machines with other work, so a time is printed and judged only when somebody
// who has left the machine alone says so: PALPATE_JUDGE_TIMES=1. Ten times what was asked is wrong on any machine.
import assert from 'node:assert/strict';

const judged = process.env.PALPATE_JUDGE_TIMES === '1';

/** Rounds of a measurement: a fixed number, more of them where it is judged. */
export const rounds = (few, many) => (judged ? many : few);

/** Prints what was measured beside what was asked for. `limit` in the unit named. */
export function measured(name, value, limit, unit) {
  console.log(`measured: ${name}: ${value.toFixed(2)} ${unit}, asked for: at most ${limit} ${unit}`);
  assert.ok(value <= (judged ? 1 : 10) * limit, `${name}: ${value} ${unit}`);
}

export function median(values) {
  const sorted = [...values].sort((a, b) => a - b);
  return sorted[Math.floor(sorted.length / 2)];
}
