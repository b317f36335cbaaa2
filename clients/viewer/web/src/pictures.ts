// SPDX-License-Identifier: Apache-2.0
import type { Figures } from './figures';
import type { OrganView } from './organ_view';
import { Quality } from './quality';
import type { Stage } from './stage';

const DRESS_MS = 400; // after the first picture of an organ
const EMPTY_MS = 100; // between looks at a page without an organ
const TURN_MS = 16; // between looks without graphics hardware, as of a display
const IDLE_MS = 40; // there, while nothing moves
const HIDDEN_MS = 1000; // longest wait for the browser
const FLOOR_MS = 2500; // without graphics hardware the floor comes so much later: it would hold up a press that comes at once

/** Draws a picture when something changed, and none while all is at rest. */
export class Pictures {
  private readonly quality: Quality;
  private drew = false; // in this turn
  private unfinishedMs = NaN; // begin of a picture that the browser still works at
  private bare: OrganView | undefined; // was drawn without the tissue's spots
  private waiting: { turn: () => void; timer: number } | undefined; // for the next turn

  /** @param nowUs  viewer's clock  @param busy  whether somebody presses */
  constructor(
    private readonly stage: Stage,
    private readonly figures: Figures,
    private readonly nowUs: () => number,
    private readonly busy: () => boolean,
  ) {
    this.quality = new Quality(devicePixelRatio || 1, stage.software);
  }

  /** The canvas has another size. */
  resize(): void {
    this.stage.resize(this.quality.ratio);
  }

  due(nowMs: number): boolean {
    return !this.isUnfinished(nowMs) && this.quality.due(nowMs);
  }

  /** Without graphics hardware: whether the browser still has to do with the last picture. A hidden page never hears the end. */
  private isUnfinished(nowMs: number): boolean {
    return this.stage.software && nowMs - this.unfinishedMs < HIDDEN_MS;
  }

  /**
   * The next turn. requestAnimationFrame() keeps the display's clock running also between pictures, which takes processor time; so
   * without graphics hardware a timer draws, and asks for one frame after each picture.
   */
  next(turn: (nowMs: number) => void, isOrgan: boolean): void {
    if (isOrgan && (!this.stage.software || document.hidden)) return void requestAnimationFrame(turn);
    const restMs = Math.max(this.quality.waitMs(performance.now()), this.busy() || this.drew ? TURN_MS : IDLE_MS);
    this.drew = false;
    this.later(() => turn(performance.now()), isOrgan ? restMs : EMPTY_MS);
  }

  private later(turn: () => void, ms: number): void {
    const timer = window.setTimeout(() => {
      this.waiting = undefined;
      turn();
    }, ms);
    this.waiting = { turn, timer };
  }

  /** An organ came: the next turn, where a timer is to bring it, is due. */
  hurry(): void {
    if (!this.waiting) return;
    clearTimeout(this.waiting.timer);
    this.later(this.waiting.turn, 0);
  }

  /** @return whether there is a new picture */
  update(view: OrganView, nowMs: number): boolean {
    const moved = view.update();
    if (!moved && !this.stage.orbit.changed && !this.quality.rested(nowMs)) return false;
    if (this.quality.picture(nowMs)) this.resize();
    const start = performance.now();
    this.drew = true;
    this.unfinishedMs = start;
    this.stage.draw();
    requestAnimationFrame(() => setTimeout(() => this.finished(view))); // behind what the browser does with the picture
    this.figures.picture(start, performance.now(), this.nowUs(), moved);
    return true;
  }

  /** The look of the organ, and the floor, wait for its first picture and for a hand that presses. */
  private finished(view: OrganView): void {
    this.unfinishedMs = NaN;
    this.quality.finished(performance.now());
    if (this.bare === view) return;
    this.bare = view;
    this.atRest(() => view.dress(), Math.max(DRESS_MS, this.quality.restMs));
    if (this.stage.software) this.atRest(() => this.stage.showFloor(), Math.max(FLOOR_MS, this.quality.restMs));
  }

  private atRest(act: () => void, afterMs: number): void {
    setTimeout(() => (this.busy() ? this.atRest(act, afterMs) : act()), afterMs);
  }
}
