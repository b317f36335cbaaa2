// SPDX-License-Identifier: Apache-2.0
// Times, and what depends on them, beside their bounds. A test prints them; it judges them only with
// PALPATE_JUDGE_TIMES=1, because the machine that it runs on may have other work.
import assert from 'node:assert/strict';

const judged = process.env.PALPATE_JUDGE_TIMES === '1';

/** Rounds of a measurement: more of them where it is judged. */
export const rounds = (few, many) => (judged ? many : few);

function say(name, value, bound, unit, kept) {
  console.log(`measured: ${name}: ${value.toFixed(2)} ${unit}, bound: ${bound} ${unit}`);
  if (judged) assert.ok(kept, `${name}: ${value} ${unit}, bound: ${bound} ${unit}`);
}

/** Prints a value beside its upper bound, both in the unit named. */
export const measured = (name, value, limit, unit) => say(name, value, `at most ${limit}`, unit, value <= limit);

/** The same with a lower bound: for what a machine with other work makes smaller. */
export const measuredAtLeast = (name, value, limit, unit) => say(name, value, `at least ${limit}`, unit, value >= limit);

export function median(values) {
  const sorted = [...values].sort((a, b) => a - b);
  return sorted[Math.floor(sorted.length / 2)];
}
