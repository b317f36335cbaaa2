// SPDX-License-Identifier: Apache-2.0
// FLAG_* of idl/palpate.idl, in words for people. A test holds the numbers equal to the IDL's.
export const FLAGS: readonly { bit: number; name: string; words: string; severe: boolean }[] = [
  { bit: 1, name: 'IN_CONTACT', words: 'in contact', severe: false },
  { bit: 2, name: 'NON_FINITE_POSE', words: 'a pose was no number', severe: true },
  { bit: 4, name: 'NON_UNIT_QUATERNION', words: 'a pose had no valid orientation', severe: true },
  { bit: 8, name: 'STALE_POSE', words: 'poses stopped; the force fades', severe: true },
  { bit: 16, name: 'BEYOND_DOMAIN', words: 'deeper than the model was computed for', severe: false },
  { bit: 32, name: 'FORCE_LIMITED', words: 'force held at its limit', severe: false },
  { bit: 64, name: 'NOT_ACCESSIBLE', words: 'no answer was computed at this spot', severe: false },
  { bit: 128, name: 'RAMPING', words: 'force on its way', severe: false },
  { bit: 256, name: 'SHUTTING_DOWN', words: 'the server is going away', severe: true },
  { bit: 512, name: 'NON_FINITE_FORCE', words: 'the model overflowed', severe: true },
  { bit: 1024, name: 'POSE_OUT_OF_ORDER', words: 'poses out of order', severe: true },
  { bit: 2048, name: 'FORCE_RATE_LIMITED', words: 'force follows at its fastest rate', severe: false },
  { bit: 4096, name: 'POSE_JUMP', words: 'the tool jumped; engaged anew', severe: false },
  { bit: 8192, name: 'TWO_PUBLISHERS', words: 'somebody else sends this tool too', severe: true },
  { bit: 16384, name: 'UNKNOWN_TOOL', words: 'no such tool', severe: true },
  { bit: 32768, name: 'TOOL_NOT_CONFIGURED', words: 'the server does not answer this tool', severe: true },
  { bit: 65536, name: 'TICK_OVERRUN', words: 'ticks were missed', severe: true },
];

export const FLAG_STALE_POSE = 8;
export const FLAG_FORCE_LIMITED = 32;
export const FLAG_RAMPING = 128;
export const FLAG_FORCE_RATE_LIMITED = 2048;

/**
 * What the server's status adds to the flags of tools and answers. A tool that was once held is stale until it is held
 * again; one whose force still fades is among the frames' tools.
 */
export const flagsOfStatus = (flags: number): number => flags & ~FLAG_STALE_POSE;

/** What is worth saying of these flags; contact alone is not, the state says it. */
export function flagWords(flags: number): { words: string; severe: boolean }[] {
  return FLAGS.filter((flag) => flag.bit !== 1 && (flags & flag.bit) !== 0).map(({ words, severe }) => ({ words, severe }));
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
