// SPDX-License-Identifier: Apache-2.0
import { FLAG_IN_CONTACT, FLAG_STALE_POSE, FLAGS } from './flag_list';

/**
 * What the server's status adds to the flags of tools and answers. A tool that was once held is stale until it is held
 * again; one whose force still fades is among the frames' tools.
 */
export const flagsOfStatus = (flags: number): number => flags & ~FLAG_STALE_POSE;

/** What is worth saying of these flags; contact alone is not, the state says it. */
export function flagWords(flags: number): { words: string; severe: boolean }[] {
  return FLAGS.filter((flag) => flag.bit !== FLAG_IN_CONTACT && (flags & flag.bit) !== 0).map(({ words, severe }) => ({ words, severe }));
}

const HELD_MS = 4000; // so long people can read what lasted a millisecond

/** Each flag that was raised in the last seconds, however short it was: ticks come 1000 times a second, eyes do not. */
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
