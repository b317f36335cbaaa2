// SPDX-License-Identifier: Apache-2.0
import type { Surface } from './surface';

const GRAINS = [7, 19, 47]; // spots along the organ's diagonal, coarse to fine
const WEIGHTS = [0.45, 0.35, 0.2];

/** A number in [0, 1) for a point of the grid, the same each time: an integer hash. */
function gridValue(x: number, y: number, z: number): number {
  let h = Math.imul(x, 374761393) + Math.imul(y, 668265263) + Math.imul(z, 2147483647);
  h = Math.imul(h ^ (h >>> 13), 1274126177);
  return ((h ^ (h >>> 16)) >>> 0) / 4294967296;
}

const smooth = (t: number): number => t * t * (3 - 2 * t);
const mixed = (a: number, b: number, t: number): number => a + (b - a) * t;

/** Value noise: the grid's numbers, joined smoothly (K. Perlin, "An image synthesizer", 1985, with values for gradients). */
function noise(x: number, y: number, z: number): number {
  const [i, j, k] = [Math.floor(x), Math.floor(y), Math.floor(z)];
  const [u, v, w] = [smooth(x - i), smooth(y - j), smooth(z - k)];
  const along = (dj: number, dk: number): number => mixed(gridValue(i, j + dj, k + dk), gridValue(i + 1, j + dj, k + dk), u);
  return mixed(mixed(along(0, 0), along(1, 0), v), mixed(along(0, 1), along(1, 1), v), w);
}

/** How light the tissue is at each node, 0 to 1: spots of several sizes that stay with the organ. Cost O(nodes), once. */
export function mottled(surface: Surface): Float32Array {
  const { rest, size, mesh } = surface;
  const spots = new Float32Array(mesh.nodes);
  for (let n = 0; n < mesh.nodes; ++n)
    GRAINS.forEach((grain, g) => {
      const unit = grain / size;
      spots[n] += WEIGHTS[g] * noise(unit * rest[3 * n], unit * rest[3 * n + 1], unit * rest[3 * n + 2]);
    });
  return spots;
}
