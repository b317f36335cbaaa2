// SPDX-License-Identifier: Apache-2.0
import { niceCeiling } from './colours';
import { SPAN_US, type Sample } from './strip';
import type { ShownStrip } from './strip_view';
import { themeColour } from './theme';

const GAP_US = 50_000; // a longer silence is a gap in the line
const COLUMN = 0.5; // CSS pixels
const LEFT = 44;
const RIGHT = 6;

interface Plot {
  readonly title: string;
  readonly colour: string;
  readonly value: (sample: Sample) => number;
  readonly least: number; // least end of the scale
}

/** Force above penetration on one time axis; the newest is at the right. */
export class StripChart {
  private readonly draw2d: CanvasRenderingContext2D;
  private drawn = ''; // what the canvas shows, while it stands still

  constructor(private readonly canvas: HTMLCanvasElement) {
    const context = canvas.getContext('2d');
    if (!context) throw new Error('this browser draws no 2D canvas');
    this.draw2d = context;
  }

  draw({ samples, edgeUs, mode }: ShownStrip): void {
    const { clientWidth: w, clientHeight: h } = this.canvas;
    const ratio = Math.min(2, devicePixelRatio || 1);
    if (w === 0 || h === 0) return;
    if (this.canvas.width !== Math.round(w * ratio) || this.canvas.height !== Math.round(h * ratio)) {
      this.canvas.width = Math.round(w * ratio);
      this.canvas.height = Math.round(h * ratio);
    }
    const plots: Plot[] = [
      { title: 'N', colour: themeColour('--force'), value: (s) => s.force, least: 0.5 },
      { title: 'mm', colour: themeColour('--depth'), value: (s) => 1000 * s.penetration, least: 1 },
    ];
    const still = samples.length === 0 || mode !== 'live';
    const key = [this.canvas.width, this.canvas.height, plots[0].colour, mode, samples.length, samples.at(-1)?.tUs].join();
    if (still && key === this.drawn) return;
    this.drawn = key;
    this.draw2d.setTransform(ratio, 0, 0, ratio, 0, 0);
    this.draw2d.clearRect(0, 0, w, h);
    this.draw2d.font = '11px system-ui, "Liberation Sans", "DejaVu Sans", sans-serif';
    const foot = 15;
    const upper = Math.round(0.6 * (h - foot));
    this.plot(plots[0], samples, edgeUs, { x: LEFT, y: 8, w: w - LEFT - RIGHT, h: upper - 12 });
    this.plot(plots[1], samples, edgeUs, { x: LEFT, y: upper + 8, w: w - LEFT - RIGHT, h: h - foot - upper - 8 });
    this.times(w, h, samples.length > 0 && mode === 'held' ? 'let go' : mode === 'paused' ? 'paused' : 'now');
  }

  private plot(plot: Plot, samples: readonly Sample[], nowUs: number, box: { x: number; y: number; w: number; h: number }): void {
    const g = this.draw2d;
    const largest = samples.reduce((top, s) => Math.max(top, plot.value(s)), 0);
    const top = niceCeiling(Math.max(plot.least, 1.05 * largest));
    const xOf = (s: Sample): number => box.x + box.w * (1 - (nowUs - s.tUs) / SPAN_US);
    const yOf = (v: number): number => box.y + box.h * (1 - v / top);
    g.lineWidth = 1;
    g.strokeStyle = themeColour('--line');
    g.fillStyle = themeColour('--quiet');
    g.textAlign = 'right';
    g.textBaseline = 'middle';
    for (const v of [0, top / 2, top]) {
      const y = Math.round(yOf(v)) + 0.5;
      g.beginPath();
      g.moveTo(box.x, y);
      g.lineTo(box.x + box.w, y);
      g.stroke();
      if (v !== top / 2) g.fillText(v === top ? `${v} ${plot.title}` : '0', box.x - 5, y);
    }
    this.line(plot, samples, xOf, yOf, box);
  }

  /** Of the samples that share a column of pixels the least, the most and the last are drawn. */
  private line(plot: Plot, samples: readonly Sample[], xOf: (s: Sample) => number, yOf: (v: number) => number, box: { x: number }): void {
    const g = this.draw2d;
    g.strokeStyle = plot.colour;
    g.lineWidth = 1.6;
    g.lineJoin = 'round';
    g.beginPath();
    let before: Sample | undefined;
    let [x, y, low, high] = [-Infinity, NaN, NaN, NaN];
    const finish = (): void => {
      for (const end of [low, high, y]) if (high > low) g.lineTo(x, end);
    };
    for (const s of samples) {
      const [xNow, yNow] = [Math.max(box.x, xOf(s)), yOf(plot.value(s))];
      const gap = !before || s.tUs - before.tUs > GAP_US;
      before = s;
      if (!gap && xNow < x + COLUMN) {
        [y, low, high] = [yNow, Math.min(low, yNow), Math.max(high, yNow)];
        continue;
      }
      finish();
      if (gap) g.moveTo(xNow, yNow);
      else g.lineTo(xNow, yNow);
      [x, y, low, high] = [xNow, yNow, yNow, yNow];
    }
    finish();
    g.stroke();
    if (!before) return;
    g.fillStyle = plot.colour;
    g.beginPath();
    g.arc(xOf(before), yOf(plot.value(before)), 2.4, 0, 2 * Math.PI);
    g.fill();
  }

  /** @param end  what the right edge is called */
  private times(w: number, h: number, end: string): void {
    const g = this.draw2d;
    g.fillStyle = themeColour('--quiet');
    g.textBaseline = 'bottom';
    for (const seconds of [10, 5, 0]) {
      g.textAlign = seconds === 10 ? 'left' : seconds === 0 ? 'right' : 'center';
      g.fillText(seconds === 0 ? end : `−${seconds} s`, LEFT + (w - LEFT - RIGHT) * (1 - seconds / 10), h);
    }
  }
}
