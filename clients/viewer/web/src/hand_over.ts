// SPDX-License-Identifier: Apache-2.0
import type { Received } from './connection';
import type { Frame } from './protocol';

const MOST_ANSWERS = 16_384; // four tools at 1 kHz for four seconds

export interface Parcel {
  readonly frame: Frame;
  readonly received: readonly Received[];
}

/**
 * Hands frames from the worker to the page, one at a time. Frames that come while the page is busy are merged: the newest
 * surface and tools, every answer. A slow page gets fewer pictures, no queue, and no holes in its strip chart.
 */
export class HandOver {
  private waiting: Parcel | undefined;
  private busy = false;

  constructor(private readonly give: (parcel: Parcel) => void) {}

  add(frame: Frame, received: Received): void {
    this.waiting = this.waiting ? joined(this.waiting, frame, received) : { frame, received: [received] };
    this.next();
  }

  /** Drops what waits: its server, organ or line is gone. The page still handles the frame that it has. */
  clear(): void {
    this.waiting = undefined;
  }

  /** The page has handled the last frame. */
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

/** A frame without a surface keeps the previous frame's. */
export function joined(old: Parcel, frame: Frame, received: Received): Parcel {
  const { nodes, meshRevision, sampleUs, surfaceSeq, scale, displacement } = frame.nodes === 0 ? old.frame : frame;
  const answers = [...old.frame.answers, ...frame.answers].slice(-MOST_ANSWERS);
  return {
    frame: { ...frame, nodes, meshRevision, sampleUs, surfaceSeq, scale, displacement, answers },
    received: [...old.received, received],
  };
}
