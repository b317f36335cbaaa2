// SPDX-License-Identifier: Apache-2.0
import { SPAN_US, type Sample, type Strips } from './strip';

const HELD_US = 300_000; // after this long without an answer the curve stands still

/** live: the right edge is now; held: the tool is gone, its curve stays; paused: somebody looks at it */
export type StripMode = 'live' | 'held' | 'paused';

export interface ShownStrip {
  readonly samples: readonly Sample[];
  readonly edgeUs: number; // viewer's clock at the right edge
  readonly mode: StripMode;
}

/** Which part of which tool's strip is seen: the last press stays until the next begins, or for as long as it is paused. */
export class StripView {
  private toolId: number | undefined; // the last that was shown
  private newest: ShownStrip = { samples: [], edgeUs: NaN, mode: 'live' };
  private stopped: { shown: ShownStrip; all: readonly Sample[] } | undefined;

  /** @param toolId  the tool that is shown now; undefined: none  @param nowUs  viewer's clock */
  at(toolId: number | undefined, strips: Strips, nowUs: number): ShownStrip {
    if (this.stopped) return this.stopped.shown;
    this.toolId = toolId ?? this.toolId;
    const strip = this.toolId === undefined ? undefined : strips.of(this.toolId);
    const last = strip?.last();
    const held = last !== undefined && !(nowUs - last.tUs <= HELD_US);
    const edgeUs = held ? last.tUs + HELD_US : nowUs;
    return (this.newest = { samples: strip?.since(edgeUs - SPAN_US) ?? [], edgeUs, mode: held ? 'held' : 'live' });
  }

  get paused(): boolean {
    return this.stopped !== undefined;
  }

  /** What is seen stays as it is. */
  pause(strips: Strips): void {
    this.stopped = { shown: { ...this.newest, mode: 'paused' }, all: strips.all() };
  }

  goOn(): void {
    this.stopped = undefined;
  }

  /** What a file of the curve holds: the samples of all tools, of the time that is seen. */
  saved(strips: Strips): readonly Sample[] {
    return this.stopped?.all ?? strips.all();
  }
}
