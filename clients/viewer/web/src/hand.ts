// SPDX-License-Identifier: Apache-2.0
import type { Said } from './connection';
import type { Line } from './line';
import { element, setText } from './page';
import type { Toucher } from './pointer';
import { DEEPEST, Press } from './press';
import type { Stage } from './stage';
import type { Surface } from './surface';

const TARGET_MS = 12; // between targets
const ENDED = 'released'; // the previous tool's end
const RETRY_MS = 400; // between grabs, after the tool was taken away while the finger is down

/** Presses on the organ, from touch to release: asks for a tool and sends its targets. */
export class Hand implements Toucher {
  toolId: number | undefined; // granted
  private press_: Press | undefined;
  private wanted = 0; // m
  private askedMs = -Infinity;
  private timer = 0; // of targets, while it presses
  private readonly slider = element('depth', HTMLInputElement);
  private readonly sliderText = element('depth-text', HTMLOutputElement);
  private readonly hint = element('hint', HTMLParagraphElement);

  constructor(
    private readonly stage: Stage,
    private readonly line: Line,
    private readonly organ: () => { surface: Surface; tipRadius: number } | undefined,
    private readonly notice: (text: string) => void,
  ) {
    this.slider.max = String(1000 * DEEPEST);
    this.slider.addEventListener('input', () => this.setDepth(Number(this.slider.value) / 1000));
    this.setDepth(Number(this.slider.value) / 1000);
  }

  get pressing(): boolean {
    return this.press_ !== undefined;
  }

  press(clientX: number, clientY: number): boolean {
    const organ = this.organ();
    if (!organ) return false;
    const ray = this.stage.rayAt(clientX, clientY);
    const press = Press.begin(organ.surface, ray, organ.tipRadius, performance.now());
    if (!press) {
      if (!organ.surface.hit(ray.origin, ray.direction)) return false;
      this.notice('The organ is clamped here: no answer was computed at this spot.');
      return true;
    }
    this.press_ = press;
    clearInterval(this.timer);
    this.timer = window.setInterval(() => this.send(), TARGET_MS);
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
    this.setDepth(this.wanted + metres);
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

  private setDepth(metres: number): void {
    this.wanted = Math.min(DEEPEST, Math.max(0, metres));
    this.slider.value = String(1000 * this.wanted);
    setText(this.sliderText, `${(1000 * this.wanted).toFixed(1)} mm`);
  }

  private ask(): void {
    this.askedMs = performance.now();
    this.line.send({ type: 'grab' });
  }

  private send(): void {
    if (!this.press_) return;
    const now = performance.now();
    const target = this.press_.target(now, this.wanted);
    if (this.toolId !== undefined) this.line.hold(target, this.press_.goal(this.wanted));
    else if (now - this.askedMs > RETRY_MS) this.ask();
  }
}
