// SPDX-License-Identifier: Apache-2.0
import { numberIn } from './page';

/** Causes of late ticks: keys of the status, and words. */
const CAUSES: readonly (readonly [string, string])[] = [
  ['own_work', 'own work'],
  ['page_fault', 'page faults'],
  ['preempted', 'another thread'],
  ['stopped', 'stopped'],
  ['host_steal', 'the host'],
  ['clock_step', 'clock'],
  ['unknown', 'unknown'],
];

/** Ticks that were late and why, the most frequent cause first: "12: another thread 10, unknown 2". */
export function lateWords(late: Record<string, unknown>): string {
  const found = CAUSES.map(([key, words]) => ({ words, count: numberIn(late, key) })).filter(({ count }) => count > 0);
  if (!found.length) return Number.isFinite(numberIn(late, 'unknown')) ? 'none' : '–';
  found.sort((a, b) => b.count - a.count);
  return `${found.reduce((sum, { count }) => sum + count, 0)}: ${found.slice(0, 2).map(({ words, count }) => `${words} ${count}`).join(', ')}`;
}
