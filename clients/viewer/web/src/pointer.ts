// SPDX-License-Identifier: Apache-2.0
import type { Stage } from './stage';

export interface Toucher {
  /** @return whether the pointer is on the organ; else it turns the view */
  press(clientX: number, clientY: number): boolean;
  slide(clientX: number, clientY: number, pull: boolean): void;
  deeper(metres: number): void;
  letGo(): void;
  overOrgan(clientX: number, clientY: number): boolean;
}

interface Place {
  x: number;
  y: number;
}

const TURN = 0.0075; // rad per pixel

/** Mouse, pen and fingers: one on the organ presses, one beside it turns the view, two zoom and move it. */
export class Pointers {
  private readonly down = new Map<number, Place>();
  private presser: number | undefined;
  private pans = false;

  constructor(
    private readonly canvas: HTMLCanvasElement,
    private readonly stage: Stage,
    private readonly toucher: Toucher,
  ) {
    canvas.addEventListener('pointerdown', (event) => this.pressed(event));
    canvas.addEventListener('pointermove', (event) => this.moved(event));
    for (const end of ['pointerup', 'pointercancel', 'lostpointercapture'] as const)
      canvas.addEventListener(end, (event) => this.lifted(event));
    canvas.addEventListener('wheel', (event) => this.wheel(event), { passive: false });
    canvas.addEventListener('contextmenu', (event) => event.preventDefault());
  }

  private pressed(event: PointerEvent): void {
    event.preventDefault();
    this.canvas.focus({ preventScroll: true });
    this.canvas.setPointerCapture(event.pointerId);
    this.down.set(event.pointerId, { x: event.clientX, y: event.clientY });
    this.pans = event.button !== 0;
    if (this.down.size === 1 && event.button === 0 && this.toucher.press(event.clientX, event.clientY)) this.presser = event.pointerId;
    if (this.down.size === 2) this.stopPressing(); // two fingers move the view
    this.cursor(event);
  }

  private moved(event: PointerEvent): void {
    const before = this.down.get(event.pointerId);
    if (!before) {
      if (event.pointerType === 'mouse') this.cursor(event);
      return;
    }
    const now = { x: event.clientX, y: event.clientY };
    if (this.presser === event.pointerId) this.toucher.slide(now.x, now.y, event.shiftKey);
    else if (this.down.size === 2) this.pinch(event.pointerId, before, now);
    else if (this.down.size === 1 && this.pans) this.pan(now.x - before.x, now.y - before.y);
    else if (this.down.size === 1) this.stage.orbit.turn(-TURN * (now.x - before.x), TURN * (now.y - before.y));
    this.down.set(event.pointerId, now);
  }

  private pinch(id: number, before: Place, now: Place): void {
    const other = [...this.down].find(([key]) => key !== id)?.[1];
    if (!other) return;
    const apart = (a: Place): number => Math.max(10, Math.hypot(a.x - other.x, a.y - other.y));
    this.stage.orbit.zoom(apart(before) / apart(now));
    this.pan((now.x - before.x) / 2, (now.y - before.y) / 2);
  }

  private pan(dx: number, dy: number): void {
    const height = Math.max(1, this.canvas.clientHeight);
    this.stage.orbit.pan(dx / height, -dy / height, this.stage.fov);
  }

  private lifted(event: PointerEvent): void {
    if (!this.down.delete(event.pointerId)) return;
    if (this.presser === event.pointerId) this.stopPressing();
    this.cursor(event);
  }

  private stopPressing(): void {
    if (this.presser === undefined) return;
    this.presser = undefined;
    this.toucher.letGo();
  }

  private wheel(event: WheelEvent): void {
    event.preventDefault();
    if (this.presser !== undefined) this.toucher.deeper(-0.0005 * Math.sign(event.deltaY));
    else this.stage.orbit.zoom(Math.exp(0.0012 * Math.max(-200, Math.min(200, event.deltaY))));
  }

  private cursor(event: PointerEvent): void {
    const turning = this.down.size > 0 && this.presser === undefined;
    const over = turning ? 'turning' : this.toucher.overOrgan(event.clientX, event.clientY) ? 'organ' : '';
    this.canvas.dataset['over'] = over;
  }
}
