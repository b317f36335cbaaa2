// SPDX-License-Identifier: Apache-2.0
import { FLAG_IN_CONTACT, FLAG_RAMPING, FLAG_STALE_POSE, FLAGS } from './flag_list';

/**
 * The flags that the server's status adds to those of tools and answers. Two are left out: a tool that was once held
 * stays stale until it is held again, and one that was left in the organ ramps for as long. The frames show a tool whose force
 * still fades.
 */
export const flagsOfStatus = (flags: number): number => flags & ~(FLAG_STALE_POSE | FLAG_RAMPING);

/** Words for these flags; none for contact, which the state shows. */
export function flagWords(flags: number): { words: string; severe: boolean }[] {
  return FLAGS.filter((flag) => flag.bit !== FLAG_IN_CONTACT && (flags & flag.bit) !== 0).map(({ words, severe }) => ({ words, severe }));
}

const HELD_MS = 4000; // a flag of one millisecond stays long enough to read

/** Each flag raised in the last HELD_MS, however briefly: a tick lasts a millisecond, too short to see. */
export class RecentFlags {
  private readonly raisedMs = new Map<number, number>();

  add(flags: number, nowMs: number): void {
    for (const { bit } of FLAGS) if ((flags & bit) !== 0) this.raisedMs.set(bit, nowMs);
  }

  /** All of them, or-ed. */
  at(nowMs: number): number {
    let all = 0;
    for (const [bit, raised] of this.raisedMs) if (nowMs - raised < HELD_MS) all |= bit;
    return all;
  }

  clear(): void {
    this.raisedMs.clear();
  }
}
