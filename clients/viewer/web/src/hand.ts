// SPDX-License-Identifier: Apache-2.0
import type { Said } from './connection';
import type { DepthSlider } from './depth_slider';
import type { Line } from './line';
import { element } from './page';
import type { Toucher } from './pointer';
import { Press, type Ray } from './press';
import type { Stage } from './stage';
import type { Surface } from './surface';

const ENDED = 'released'; // the previous tool's end
const RETRY_MS = 400; // between grabs, after the tool was taken away while the finger is down

/** Presses on the organ, from touch to release: asks for a tool and sends its targets. */
export class Hand implements Toucher {
  toolId: number | undefined; // granted
  targetMs = 12; // between targets
  private press_: Press | undefined;
  private askedMs = -Infinity;
  private timer = 0; // of targets, while it presses
  private readonly hint = element('hint', HTMLParagraphElement);

  /** @param absent  why nobody answers a press; empty: somebody does */
  constructor(
    private readonly stage: Stage,
    private readonly line: Line,
    private readonly depth: DepthSlider,
    private readonly absent: () => string,
    private readonly organ: () => { surface: Surface; tipRadius: number } | undefined,
    private readonly notice: (text: string) => void,
  ) {}

  get pressing(): boolean {
    return this.press_ !== undefined;
  }

  press(clientX: number, clientY: number): boolean {
    const organ = this.organ();
    if (!organ) return this.refused();
    const ray = this.stage.rayAt(clientX, clientY);
    if (this.absent() && organ.surface.hit(ray.origin, ray.direction)) return this.refused();
    const press = Press.begin(organ.surface, ray, organ.tipRadius, performance.now());
    if (!press) {
      if (!organ.surface.hit(ray.origin, ray.direction)) return false;
      this.notice(this.whyNot(organ.surface, ray));
      return true;
    }
    this.press_ = press;
    clearInterval(this.timer);
    this.timer = window.setInterval(() => this.send(), this.targetMs);
    this.hint.dataset['gone'] = '';
    this.ask();
    return true;
  }

  slide(clientX: number, clientY: number, pull: boolean): void {
    const ray = this.stage.rayAt(clientX, clientY);
    if (pull) this.press_?.pullTo(ray);
    else this.press_?.slideTo(ray);
  }

  deeper(metres: number): void {
    this.depth.set(this.depth.depth + metres);
  }

  letGo(): void {
    if (!this.press_) return;
    this.drop();
    this.line.send({ type: 'release' });
  }

  overOrgan(clientX: number, clientY: number): boolean {
    const organ = this.organ();
    if (!organ) return false;
    const ray = this.stage.rayAt(clientX, clientY);
    return organ.surface.hit(ray.origin, ray.direction) !== undefined;
  }

  /** The viewer's answer to a grab, the loss of the tool, or the end of the previous tool. */
  said(message: Said): void {
    if (!this.press_) return;
    if (message['granted'] === true) {
      this.toolId = Number(message['tool_id']);
      this.send();
      if (message['message']) this.notice(String(message['message']));
    } else if (this.toolId !== undefined) {
      this.toolId = undefined; // e.g. the page stalled; while the finger is down it asks again
    } else if (message['message'] !== ENDED) {
      this.notice(String(message['message'] || 'There is no free tool.'));
    }
  }

  /** The line broke or another organ came: the hand holds nothing. */
  drop(): void {
    clearInterval(this.timer);
    this.press_ = undefined;
    this.toolId = undefined;
    this.line.hold(undefined);
  }

  /** @return whether it was said why nobody answers */
  private refused(): boolean {
    if (this.absent()) this.notice(this.absent());
    return this.absent() !== '';
  }

  private whyNot(surface: Surface, ray: Ray): string {
    const hit = surface.hit(ray.origin, ray.direction);
    return hit && surface.clampedAt(hit)
      ? 'The organ is clamped here: no answer was computed at this spot.'
      : 'No tool may touch here: no answer was computed at this spot.';
  }

  private ask(): void {
    this.askedMs = performance.now();
    this.line.send({ type: 'grab' });
  }

  private send(): void {
    if (!this.press_) return;
    const now = performance.now();
    const target = this.press_.target(now, this.depth.depth);
    if (this.toolId !== undefined) this.line.hold(target, this.press_.goal(this.depth.depth));
    else if (now - this.askedMs > RETRY_MS) this.ask();
  }
}
