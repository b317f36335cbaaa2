// SPDX-License-Identifier: Apache-2.0
import type { Received } from './connection';
import type { Frame } from './protocol';
import { Recent } from './recent';

/** Rates and ages of pictures and frames, for the panel and for tests. */
export class Figures {
  readonly drawn = new Recent(); // one value per picture: duration of drawing, ms
  readonly received = new Recent(); // one value per frame: bytes
  readonly decodedMs = new Recent(); // DDS sample at the viewer -> frame decoded here
  readonly shownMs = new Recent(); // DDS sample at the viewer -> handed to the screen
  frames = 0;
  pictures = 0;
  organSeenMs = NaN; // from the start of loading to the first picture of an organ
  private newestSampleUs = NaN;

  frame(frame: Frame, received: readonly Received[], nowMs: number): void {
    for (const { bytes, delayMs } of received) {
      ++this.frames;
      this.received.add(nowMs, bytes);
      if (Number.isFinite(delayMs)) this.decodedMs.add(nowMs, delayMs);
    }
    if (frame.nodes > 0) this.newestSampleUs = frame.sampleUs;
  }

  /** @param nowUs  viewer's clock when the picture was done; NaN while unknown @param moved  the organ or a tool changed */
  picture(startMs: number, endMs: number, nowUs: number, moved: boolean): void {
    ++this.pictures;
    if (moved && Number.isNaN(this.organSeenMs)) this.organSeenMs = endMs;
    this.drawn.add(endMs, endMs - startMs);
    const delayMs = (nowUs - this.newestSampleUs) / 1000;
    if (moved && Number.isFinite(delayMs)) this.shownMs.add(endMs, delayMs);
    this.newestSampleUs = NaN;
  }
}
