// SPDX-License-Identifier: Apache-2.0
import type { ViewerClock } from './clock';
import type { Frame } from './protocol';
import { Recent } from './recent';

/** How fast pictures and frames come, and how old they are: what the panel prints and tests read. */
export class Figures {
  readonly drawn = new Recent(); // a value a picture: ms that drawing took
  readonly received = new Recent(); // a value a frame: bytes
  readonly decodedMs = new Recent(); // DDS sample at the viewer -> frame decoded here
  readonly shownMs = new Recent(); // DDS sample at the viewer -> handed to the screen
  frames = 0;
  pictures = 0;
  private newestSampleUs = NaN;
  private lastSurface = -1;

  frame(frame: Frame, bytes: number, clock: ViewerClock, nowMs: number): void {
    ++this.frames;
    this.received.add(nowMs, bytes);
    if (frame.nodes === 0 || frame.surfaceSeq === this.lastSurface) return;
    this.lastSurface = frame.surfaceSeq;
    this.newestSampleUs = frame.sampleUs;
    if (clock.known) this.decodedMs.add(nowMs, (clock.viewerUs(nowMs) - frame.sampleUs) / 1000);
  }

  picture(startMs: number, endMs: number, clock: ViewerClock): void {
    ++this.pictures;
    this.drawn.add(endMs, endMs - startMs);
    if (!clock.known || Number.isNaN(this.newestSampleUs)) return;
    this.shownMs.add(endMs, (clock.viewerUs(endMs) - this.newestSampleUs) / 1000);
    this.newestSampleUs = NaN;
  }

  clear(): void {
    for (const recent of [this.drawn, this.received, this.decodedMs, this.shownMs]) recent.clear();
  }
}
