// SPDX-License-Identifier: Apache-2.0
import { FLAG_FORCE_LIMITED, FLAG_FORCE_RATE_LIMITED, FLAG_RAMPING } from './flag_list';
import { STATE_FREE, type Answer, type Frame, type Tool } from './protocol';
import type { Surface } from './surface';
import { norm, pointOf, sub, type Vec3 } from './vec';

const AS_NEAR = 0.1; // of the reach: touches are as near if their distances differ by no more, since a pressed anchor creeps
const NOT_THE_ORGANS = FLAG_RAMPING | FLAG_FORCE_LIMITED | FLAG_FORCE_RATE_LIMITED;

/** The stiffness felt at each spot: a map that the palpating finger draws. */
export class FeltMap {
  readonly value: Float32Array; // N/m
  readonly weight: Float32Array; // 0: never felt .. 1: right under a tool
  private readonly distance: Float32Array; // m, of the nearest touch
  private readonly depth: Float32Array; // m, of the touch whose stiffness the node has
  low = Infinity;
  high = -Infinity;

  constructor(
    private readonly surface: Surface,
    private reach: number, // m
  ) {
    this.value = new Float32Array(surface.mesh.nodes);
    this.weight = new Float32Array(surface.mesh.nodes);
    this.distance = new Float32Array(surface.mesh.nodes).fill(Infinity);
    this.depth = new Float32Array(surface.mesh.nodes);
  }

  /** Stiffness at the node nearest to a point of the rest surface, N/m; NaN where nothing was felt. */
  at(point: Vec3): number {
    const { rest, mesh } = this.surface;
    let [best, least] = [0, Infinity];
    for (let n = 0; n < mesh.nodes; ++n) {
      const d = norm(sub(pointOf(rest, n), point));
      if (d < least) [best, least] = [n, d];
    }
    return this.weight[best] > 0 ? this.value[best] : NaN;
  }

  /** @return whether the map changed */
  learn(frame: Frame): boolean {
    let learnt = false;
    for (const tool of frame.tools) {
      if (tool.state === STATE_FREE || tool.flags & NOT_THE_ORGANS) continue;
      const answer = frame.answers.findLast((a) => a.toolId === tool.id);
      if (!answer || !(answer.stiffness > 0) || answer.flags & NOT_THE_ORGANS) continue;
      this.mark(tool, answer);
      learnt = true;
    }
    if (learnt) this.measure();
    return learnt;
  }

  /** Stiffness at node n on the scale from softest to stiffest, 0 to 1. */
  share(n: number): number {
    const range = this.high - this.low;
    return range > 0 ? (this.value[n] - this.low) / range : 0.5;
  }

  /** Radius that a touch paints round its anchor, m. Clears the map. */
  setReach(reach: number): void {
    this.reach = reach;
    this.clear();
  }

  clear(): void {
    this.value.fill(0);
    this.weight.fill(0);
    this.distance.fill(Infinity);
    this.depth.fill(0);
    [this.low, this.high] = [Infinity, -Infinity];
  }

  /** The nearest touch counts, however long another lasts, and of those as near the deepest: not the last before the tool left. */
  private mark(tool: Tool, { stiffness, penetration }: Answer): void {
    const { rest, mesh } = this.surface;
    const depth = Math.fround(penetration);
    for (let n = 0; n < mesh.nodes; ++n) {
      const r = Math.hypot(rest[3 * n] - tool.anchor[0], rest[3 * n + 1] - tool.anchor[1], rest[3 * n + 2] - tool.anchor[2]);
      if (r >= this.reach) continue;
      const nearer = (this.distance[n] - r) / this.reach;
      if (nearer < -AS_NEAR || (nearer <= AS_NEAR && depth < this.depth[n])) continue;
      this.value[n] = stiffness;
      this.depth[n] = depth;
      this.distance[n] = Math.min(r, this.distance[n]); // never more: creeping must not lead away step by step
      this.weight[n] = (1 - (this.distance[n] / this.reach) ** 2) ** 2;
    }
  }

  private measure(): void {
    [this.low, this.high] = [Infinity, -Infinity];
    for (let n = 0; n < this.value.length; ++n) {
      if (this.weight[n] < 0.02) continue;
      this.low = Math.min(this.low, this.value[n]);
      this.high = Math.max(this.high, this.value[n]);
    }
  }
}
