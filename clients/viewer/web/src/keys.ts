// SPDX-License-Identifier: Apache-2.0
import type { Toucher } from './pointer';
import type { Stage } from './stage';

const TURN = 0.09; // rad per key press
const SLIDE = 4; // pixels
const DEPTH = 0.0005; // m

/** The keyboard on the organ: turns, zooms, presses at the centre and slides from there. */
export class Keys {
  private presses = false;
  private at = { x: 0, y: 0 };

  constructor(
    private readonly canvas: HTMLCanvasElement,
    private readonly stage: Stage,
    private readonly toucher: Toucher,
    private readonly picture: () => void,
  ) {
    canvas.addEventListener('keydown', (event) => this.pressed(event));
    canvas.addEventListener('keyup', (event) => {
      if (event.key === 'Enter' || event.key === ' ') this.letGo();
    });
    canvas.addEventListener('blur', () => this.letGo());
  }

  private pressed(event: KeyboardEvent): void {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const act = this.actions(event)[event.key];
    if (!act) return;
    event.preventDefault();
    act();
  }

  private actions(event: KeyboardEvent): Record<string, () => void> {
    const { orbit } = this.stage;
    const arrow = (x: number, y: number) => () => (this.presses ? this.slide(x, y, event.shiftKey) : orbit.turn(-TURN * x, TURN * y));
    const begin = (): void => (event.repeat ? undefined : this.begin());
    return {
      ArrowLeft: arrow(-1, 0),
      ArrowRight: arrow(1, 0),
      ArrowUp: arrow(0, -1),
      ArrowDown: arrow(0, 1),
      '+': () => orbit.zoom(0.9),
      '=': () => orbit.zoom(0.9),
      '-': () => orbit.zoom(1 / 0.9),
      Home: () => orbit.reset(),
      PageDown: () => this.toucher.deeper(DEPTH),
      PageUp: () => this.toucher.deeper(-DEPTH),
      Escape: () => this.letGo(),
      p: this.picture,
      Enter: begin,
      ' ': begin,
    };
  }

  private begin(): void {
    const box = this.canvas.getBoundingClientRect();
    this.at = { x: box.left + box.width / 2, y: box.top + box.height / 2 };
    this.presses = this.toucher.press(this.at.x, this.at.y);
  }

  private slide(x: number, y: number, pull: boolean): void {
    this.at = { x: this.at.x + SLIDE * x, y: this.at.y + SLIDE * y };
    this.toucher.slide(this.at.x, this.at.y, pull);
  }

  private letGo(): void {
    if (!this.presses) return;
    this.presses = false;
    this.toucher.letGo();
  }
}
