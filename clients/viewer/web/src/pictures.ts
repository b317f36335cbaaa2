// SPDX-License-Identifier: Apache-2.0
import type { Figures } from './figures';
import type { OrganView } from './organ_view';
import { Quality } from './quality';
import type { Stage } from './stage';

const DRESS_MS = 400; // after the first picture of an organ
const EMPTY_MS = 100; // between looks at a page without an organ
const TURN_MS = 16; // between looks without graphics hardware, as of a display
const IDLE_MS = 40; // there, while nobody presses
const FLOOR_MS = 2500; // without graphics hardware the floor comes so much later: it would hold up a press that comes at once

/** Draws a picture when something changed, and none while all is at rest. */
export class Pictures {
  private readonly quality: Quality;
  private bare: OrganView | undefined; // was drawn without the tissue's spots

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
    return this.quality.due(nowMs);
  }

  /**
   * The next turn: of the display, or by a timer where each costs the processor's time. A display that waits for a page which draws
   * keeps turning, so without graphics hardware a picture is drawn before the display is asked for.
   */
  next(turn: (nowMs: number) => void, isOrgan: boolean): void {
    if (isOrgan && (!this.stage.software || document.hidden)) return void requestAnimationFrame(turn);
    const restMs = Math.max(this.quality.waitMs(performance.now()), this.busy() ? TURN_MS : IDLE_MS);
    setTimeout(() => turn(performance.now()), isOrgan ? restMs : EMPTY_MS);
  }

  /** @return whether there is a new picture */
  update(view: OrganView, nowMs: number): boolean {
    const moved = view.update();
    if (!moved && !this.stage.orbit.changed && !this.quality.rested(nowMs)) return false;
    if (this.quality.picture(nowMs)) this.resize();
    const start = performance.now();
    this.stage.draw();
    requestAnimationFrame(() => setTimeout(() => this.finished(view))); // behind what the browser does with the picture
    this.figures.picture(start, performance.now(), this.nowUs(), moved);
    return true;
  }

  /** The look of the organ, and the floor, wait for its first picture and for a hand that presses. */
  private finished(view: OrganView): void {
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
