// SPDX-License-Identifier: Apache-2.0
import { FLAG_FORCE_LIMITED, FLAG_FORCE_RATE_LIMITED, FLAG_RAMPING } from './flag_list';
import { STATE_FREE, type Frame, type Tool } from './protocol';
import type { Surface } from './surface';
import { norm, pointOf, sub, type Vec3 } from './vec';

const NOT_THE_ORGANS = FLAG_RAMPING | FLAG_FORCE_LIMITED | FLAG_FORCE_RATE_LIMITED;

/** The stiffness felt at each spot: a map that the palpating finger draws. */
export class FeltMap {
  readonly value: Float32Array; // N/m
  readonly weight: Float32Array; // 0: never felt .. 1: right under a tool
  low = Infinity;
  high = -Infinity;

  constructor(
    private readonly surface: Surface,
    private reach: number, // m
  ) {
    this.value = new Float32Array(surface.mesh.nodes);
    this.weight = new Float32Array(surface.mesh.nodes);
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
      this.mark(tool, answer.stiffness);
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
    [this.low, this.high] = [Infinity, -Infinity];
  }

  private mark(tool: Tool, stiffness: number): void {
    const { rest, mesh } = this.surface;
    for (let n = 0; n < mesh.nodes; ++n) {
      const r = Math.hypot(rest[3 * n] - tool.anchor[0], rest[3 * n + 1] - tool.anchor[1], rest[3 * n + 2] - tool.anchor[2]);
      if (r >= this.reach) continue;
      const w = Math.fround((1 - (r / this.reach) ** 2) ** 2);
      if (w < this.weight[n]) continue; // the nearest touch counts, however long another lasts
      this.value[n] = stiffness;
      this.weight[n] = w;
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
