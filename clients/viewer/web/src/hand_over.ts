// SPDX-License-Identifier: Apache-2.0
import type { Received } from './connection';
import type { Frame } from './protocol';

const MOST_ANSWERS = 16_384; // four tools at 1 kHz for four seconds

export interface Parcel {
  readonly frame: Frame;
  readonly received: readonly Received[];
}

/**
 * One frame at a time from the worker to the page. What comes while the page is busy is put together: the newest
 * surface and tools, every answer. A slow page gets fewer pictures, never a queue, and its strip chart has no holes.
 */
export class HandOver {
  private waiting: Parcel | undefined;
  private busy = false;

  constructor(private readonly give: (parcel: Parcel) => void) {}

  add(frame: Frame, received: Received): void {
    this.waiting = this.waiting ? joined(this.waiting, frame, received) : { frame, received: [received] };
    this.next();
  }

  /** What waits is of a server, an organ or a line that is not there any more. What the page has got it still deals with. */
  clear(): void {
    this.waiting = undefined;
  }

  /** The page has dealt with the last one. */
  taken(): void {
    this.busy = false;
    this.next();
  }

  private next(): void {
    if (this.busy || !this.waiting) return;
    this.busy = true;
    const parcel = this.waiting;
    this.waiting = undefined;
    this.give(parcel);
  }
}

/** A frame without a surface keeps that of the one before. */
export function joined(old: Parcel, frame: Frame, received: Received): Parcel {
  const { nodes, meshRevision, sampleUs, surfaceSeq, scale, displacement } = frame.nodes === 0 ? old.frame : frame;
  const answers = [...old.frame.answers, ...frame.answers].slice(-MOST_ANSWERS);
  return {
    frame: { ...frame, nodes, meshRevision, sampleUs, surfaceSeq, scale, displacement, answers },
    received: [...old.received, received],
  };
}
