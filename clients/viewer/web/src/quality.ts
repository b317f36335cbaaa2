// SPDX-License-Identifier: Apache-2.0
const LOWEST = 0.6;
const SLOW_MS = 45;
const FAST_MS = 14;
const COUNT = 12;
const REST_MS = 300;
const REST_PICTURES = 4; // or as long as so many pictures take
const SOFTWARE_MS = 38; // least time between pictures
const MOST_REST_MS = 1000; // after a picture that took longer the page stood still

/**
 * Pixels drawn per CSS pixel: the screen's own, fewer where drawing is slow (software rendering), so that the organ
 * follows the hand. One sharp picture follows when it rests. A dozen pictures in a row decide.
 */
export class Quality {
  private intervals: number[] = [];
  private lastMs = NaN;
  private tookMs = 0; // of the last picture, with what the browser did with it
  private nextMs = -Infinity; // earliest next picture
  private moving: number; // ratio while pictures follow each other
  private readonly sharp: number;
  private sharpen = false;
  ratio: number;

  /** @param most  pixels of the screen per CSS pixel */
  constructor(
    most: number,
    private readonly software: boolean,
  ) {
    this.sharp = Math.min(2, software ? Math.max(1.5, most) : most); // instead of the hardware's smoothing
    this.moving = Math.min(most, software ? 0.75 : 2);
    this.ratio = this.moving;
  }

  /** Whether to draw now: software rendering leaves processor time to the threads that bring the forces. */
  due(nowMs: number): boolean {
    return !this.software || !(nowMs < this.nextMs);
  }

  /** Until due(), ms. */
  waitMs(nowMs: number): number {
    return Math.max(0, this.nextMs - nowMs);
  }

  /** The page's thread is free again after a picture. What took longer than usual leaves as much time to others. */
  finished(nowMs: number): void {
    this.tookMs = Math.min(nowMs - this.lastMs, SOFTWARE_MS + MOST_REST_MS);
    this.nextMs = Math.max(this.lastMs + SOFTWARE_MS, nowMs + this.tookMs - SOFTWARE_MS);
  }

  /** Nothing moved for this long: at rest, ms. */
  get restMs(): number {
    return Math.max(REST_MS, REST_PICTURES * this.tookMs);
  }

  /** Whether it is time for the sharp picture: nothing moved for a while. */
  rested(nowMs: number): boolean {
    this.sharpen = this.ratio < this.sharp && nowMs - this.lastMs > this.restMs;
    return this.sharpen;
  }

  /** Before each picture. @return whether the ratio changed */
  picture(nowMs: number): boolean {
    const before = this.ratio;
    if (!this.sharpen) this.judge(nowMs - this.lastMs);
    this.ratio = this.sharpen ? this.sharp : this.moving;
    this.sharpen = false;
    this.lastMs = nowMs;
    this.nextMs = nowMs + SOFTWARE_MS;
    return Math.abs(this.ratio - before) > 0.01;
  }

  private judge(interval: number): void {
    if (!(interval < 800)) return; // a rest in between
    this.intervals.push(interval);
    if (this.intervals.length < COUNT) return;
    const median = this.intervals.sort((a, b) => a - b)[COUNT / 2];
    this.intervals = [];
    if (median > SLOW_MS) this.moving = Math.max(LOWEST, this.moving * 0.75);
    else if (median < FAST_MS) this.moving = Math.min(this.sharp, this.moving * 1.15);
  }
}
