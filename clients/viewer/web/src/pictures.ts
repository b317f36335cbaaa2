// SPDX-License-Identifier: Apache-2.0
import type { Figures } from './figures';
import type { OrganView } from './organ_view';
import { Quality } from './quality';
import type { Stage } from './stage';

const DRESS_MS = 400; // after the first picture of an organ
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

  /** @return whether there is a new picture */
  update(view: OrganView, nowMs: number): boolean {
    const moved = view.update();
    if (!moved && !this.stage.orbit.changed && !this.quality.rested(nowMs)) return false;
    if (this.quality.picture(nowMs)) this.resize();
    const start = performance.now();
    this.stage.draw();
    setTimeout(() => this.quality.finished(performance.now())); // behind what the browser does with the picture
    this.figures.picture(start, performance.now(), this.nowUs(), moved);
    if (this.bare !== view) this.dressSoon((this.bare = view));
    return true;
  }

  /** The look of the organ, and the floor, wait for its first picture and for a hand that presses. */
  private dressSoon(view: OrganView): void {
    this.atRest(() => view.dress(), DRESS_MS);
    if (this.stage.software) this.atRest(() => this.stage.showFloor(), FLOOR_MS);
  }

  private atRest(act: () => void, afterMs: number): void {
    setTimeout(() => (this.busy() ? this.atRest(act, afterMs) : act()), afterMs);
  }
}
