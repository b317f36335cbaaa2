// SPDX-License-Identifier: Apache-2.0
import { scale, type Vec3 } from './vec';

/** Linear light, 0 to 1, as three.js takes vertex colours. */
export type Rgb = Vec3;

export const linearOf = (c: number): number => (c <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4);
export const encodedOf = (c: number): number => (c <= 0.0031308 ? 12.92 * c : 1.055 * c ** (1 / 2.4) - 0.055);

/** "#rrggbb" (sRGB) as linear light. */
export function rgbOf(hex: string): Rgb {
  const byte = (at: number): number => linearOf(parseInt(hex.slice(at, at + 2), 16) / 255);
  return [byte(1), byte(3), byte(5)];
}

export function hexOf(rgb: Rgb): string {
  const byte = (c: number): string =>
    Math.round(255 * Math.min(1, Math.max(0, encodedOf(c))))
      .toString(16)
      .padStart(2, '0');
  return `#${rgb.map(byte).join('')}`;
}

// OKLab (Ottosson 2020, "A perceptual color space for image processing"): equal steps look equal.
const LMS = [
  [0.4122214708, 0.5363325363, 0.0514459929],
  [0.2119034982, 0.6806995451, 0.1073969566],
  [0.0883024619, 0.2817188376, 0.6299787005],
];
const LAB = [
  [0.2104542553, 0.793617785, -0.0040720468],
  [1.9779984951, -2.428592205, 0.4505937099],
  [0.0259040371, 0.7827717662, -0.808675766],
];
const LMS_OF_LAB = [
  [1, 0.3963377774, 0.2158037573],
  [1, -0.1055613458, -0.0638541728],
  [1, -0.0894841775, -1.291485548],
];
const RGB_OF_LMS = [
  [4.0767416621, -3.3077115913, 0.2309699292],
  [-1.2684380046, 2.6097574011, -0.3413193965],
  [-0.0041960863, -0.7034186147, 1.707614701],
];

const apply = (m: readonly (readonly number[])[], v: Vec3): Vec3 => {
  const row = (r: readonly number[]): number => r[0] * v[0] + r[1] * v[1] + r[2] * v[2];
  return [row(m[0]), row(m[1]), row(m[2])];
};
export const labOf = (rgb: Rgb): Vec3 => apply(LAB, apply(LMS, rgb).map(Math.cbrt) as unknown as Vec3);
export const rgbOfLab = (lab: Vec3): Rgb =>
  apply(RGB_OF_LMS, apply(LMS_OF_LAB, lab).map((c) => c ** 3) as unknown as Vec3).map((c) =>
    Math.min(1, Math.max(0, c)),
  ) as unknown as Vec3;

/** A map from [0, 1] to colours: control points joined in OKLab, tabulated. */
export class ColourMap {
  private readonly table: Float32Array;
  private readonly steps = 256;

  constructor(points: readonly string[]) {
    const labs = points.map((hex) => labOf(rgbOf(hex)));
    this.table = new Float32Array(3 * (this.steps + 1));
    for (let i = 0; i <= this.steps; ++i) {
      const x = (i / this.steps) * (labs.length - 1);
      const k = Math.min(labs.length - 2, Math.floor(x));
      const lab = scale(labs[k], 1 - (x - k)).map((c, axis) => c + (x - k) * labs[k + 1][axis]) as unknown as Vec3;
      this.table.set(rgbOfLab(lab), 3 * i);
    }
  }

  /** Colour of x, clamped to [0, 1], as linear light into out[at ..]. */
  write(x: number, out: Float32Array, at: number): void {
    const i = 3 * Math.round(this.steps * Math.min(1, Math.max(0, x)));
    out[at] = this.table[i];
    out[at + 1] = this.table[i + 1];
    out[at + 2] = this.table[i + 2];
  }

  at(x: number): Rgb {
    const out = new Float32Array(3);
    this.write(x, out, 0);
    return [out[0], out[1], out[2]];
  }

  /** For a legend: every tenth. */
  stops(): string[] {
    return Array.from({ length: 11 }, (_, i) => hexOf(this.at(i / 10)));
  }

  gradient(direction = 'to right'): string {
    return `linear-gradient(${direction}, ${this.stops().map((stop, i) => `${stop} ${10 * i}%`).join(', ')})`;
  }
}

/** Displacement: porcelain at rest, darker with depth; lightness alone shows the order. The control points are our own. */
export const DISPLACEMENT = new ColourMap(['#efe6d8', '#b9d8cf', '#6db7c4', '#3d86b8', '#35539f', '#2c2468']);

/** Stiffness: viridis (S. van der Walt and N. Smith, matplotlib 2015, CC0), sampled at every eighth. */
export const STIFFNESS = new ColourMap([
  '#440154', '#472d7b', '#3b528b', '#2c728e', '#21918c', '#28ae80', '#5ec962', '#addc30', '#fde725',
]);

/** Of the organ itself, from its darkest spots to its lightest: the red-brown of a liver, wet and lit. */
export const TISSUE = new ColourMap(['#7d2f2b', '#a04539', '#bd6a55']);
export const NOT_FELT = rgbOf('#cfcac3');
/** Where the organ is clamped: darker than what is not felt, and without the colour of any scale. */
export const CLAMPED = '#6f6a66';

/** What no tool may touch although it moves: no answer was computed there. A grey with some violet, which no scale has. */
export const NO_ANSWER = '#a893b4';
/** Of an organ that nobody answers for. */
export const ABSENT = rgbOf('#a7a4a0');

/** Of regions, in turn: M. Okabe and K. Ito, "Color Universal Design" (2008), which colour-blind people tell apart. */
export const REGIONS = ['#d55e00', '#009e73', '#cc79a7', '#0072b2', '#f0e442', '#56b4e9'];

/** The next larger of 1, 2, 5 times a power of ten: the end of a scale that does not flicker. */
export function niceCeiling(x: number): number {
  if (!(x > 0)) return 1;
  const power = 10 ** Math.floor(Math.log10(x));
  const step = [1, 2, 5, 10].find((s) => s * power >= x * (1 - 1e-9)) ?? 10;
  return step * power;
}
