// SPDX-License-Identifier: Apache-2.0
const LOWEST = 0.5;
const SLOW_MS = 45;
const FAST_MS = 14;
const COUNT = 12;

/**
 * How many pixels are drawn per CSS pixel: as many as the screen has, fewer where drawing is slow (software
 * rendering), so that the organ follows the hand. Judged by a dozen pictures that follow each other.
 */
export class Quality {
  private intervals: number[] = [];
  private lastMs = NaN;
  ratio: number;

  constructor(
    private readonly most: number,
    software: boolean,
  ) {
    this.ratio = Math.min(most, software ? 0.75 : 2);
  }

  /** @return whether the ratio changed */
  picture(nowMs: number): boolean {
    const interval = nowMs - this.lastMs;
    this.lastMs = nowMs;
    if (!(interval < 800)) return false; // at rest in between
    this.intervals.push(interval);
    if (this.intervals.length < COUNT) return false;
    const median = this.intervals.sort((a, b) => a - b)[COUNT / 2];
    this.intervals = [];
    const before = this.ratio;
    if (median > SLOW_MS) this.ratio = Math.max(LOWEST, this.ratio * 0.75);
    else if (median < FAST_MS) this.ratio = Math.min(this.most, 2, this.ratio * 1.15);
    return Math.abs(this.ratio - before) > 0.01;
  }
}
