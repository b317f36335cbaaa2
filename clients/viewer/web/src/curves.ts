// SPDX-License-Identifier: Apache-2.0
import { element, setText } from './page';
import type { Frame, Tool } from './protocol';
import { UNKNOWN } from './settings';
import { Strips, type Sample } from './strip';
import { StripChart } from './strip_chart';
import { StripView } from './strip_view';

/** The curves of force and penetration, and the button that holds them. */
export class Curves {
  readonly strips = new Strips();
  settings = UNKNOWN; // in force: each sample keeps them
  private readonly view = new StripView();
  private readonly chart = new StripChart(element('strip', HTMLCanvasElement));
  private readonly button = element('pause', HTMLButtonElement);

  constructor() {
    this.button.addEventListener('click', () => this.pause());
  }

  add(frame: Frame): void {
    this.strips.add(frame.answers, this.settings);
  }

  /** Nobody answers, or another organ does. */
  clear(): void {
    this.strips.clear();
    this.settings = UNKNOWN;
  }

  /** @param tool  that is shown now  @param nowUs  viewer's clock */
  draw(tool: Tool | undefined, nowUs: number): void {
    this.chart.draw(this.view.at(tool?.id, this.strips, nowUs));
  }

  /** What a file of them holds. */
  get saved(): readonly Sample[] {
    return this.view.saved(this.strips);
  }

  private pause(): void {
    if (this.view.paused) this.view.goOn();
    else this.view.pause(this.strips);
    this.button.setAttribute('aria-pressed', String(this.view.paused));
    setText(this.button, this.view.paused ? 'Go on' : 'Pause');
  }
}
