// SPDX-License-Identifier: Apache-2.0
import { restNormalAt, type Surface } from './surface';
import { add, dot, norm, scale, sub, type Vec3 } from './vec';

export const DEEPEST = 0.015; // m; the server clamps beyond its domain and says so
const ABOVE = 0.001; // m; a press begins this far above the surface
const SPEED = 0.012; // m/s of a press, down and up
const MOST_MS = 100; // of one move: a page that stood still longer does not catch up

export interface Ray {
  readonly origin: Vec3;
  readonly direction: Vec3; // unit length
}

const bounded = (depth: number): number => Math.min(DEEPEST, Math.max(-ABOVE, depth));
const travelIn = (ms: number): number => (SPEED * Math.min(MOST_MS, Math.max(0, ms))) / 1000;

/** Where a press is some time after its target, on the way to its goal: for a page that is late with the next target. */
export function later(target: Vec3, goal: Vec3, ms: number): Vec3 {
  const way = sub(goal, target);
  const length = norm(way);
  return add(target, scale(way, length > 0 ? Math.min(1, travelIn(ms) / length) : 0));
}

/**
 * A finger on the organ: its place, its depth, and the resulting tool pose. It sinks with time, down to the depth set.
 * Depths count from the surface at rest, along its outward normal.
 */
export class Press {
  private constructor(
    private readonly surface: Surface,
    private spot: Vec3,
    private normal: Vec3,
    private readonly tipRadius: number,
    private depthNow: number,
    private timeMs: number,
  ) {}

  /** @return undefined when the ray meets no accessible part of the displayed organ */
  static begin(surface: Surface, ray: Ray, tipRadius: number, nowMs: number): Press | undefined {
    const hit = surface.hit(ray.origin, ray.direction);
    if (!hit || !surface.accessibleAt(hit)) return undefined;
    return new Press(surface, surface.at(surface.rest, hit), restNormalAt(surface, hit), tipRadius, -ABOVE, nowMs);
  }

  /** Slides over the surface at rest to where the ray meets it; stays when the ray misses. */
  slideTo(ray: Ray): boolean {
    const hit = this.surface.hit(ray.origin, ray.direction, this.surface.rest);
    if (!hit || !this.surface.accessibleAt(hit)) return false;
    this.spot = this.surface.at(this.surface.rest, hit);
    this.normal = restNormalAt(this.surface, hit);
    return true;
  }

  /** Pulls in the plane that touches the surface at the finger, instead of following the surface. */
  pullTo(ray: Ray): boolean {
    const steep = dot(ray.direction, this.normal);
    if (Math.abs(steep) < 0.05) return false;
    const distance = dot(sub(this.spot, ray.origin), this.normal) / steep;
    if (!(distance > 0)) return false;
    this.spot = add(ray.origin, scale(ray.direction, distance));
    return true;
  }

  /** Moves towards the wanted depth, m. @return the tip's centre, m */
  target(nowMs: number, wanted: number): Vec3 {
    const step = travelIn(nowMs - this.timeMs);
    this.depthNow += Math.min(step, Math.max(-step, bounded(wanted) - this.depthNow));
    this.timeMs = nowMs;
    return this.tipAt(this.depthNow);
  }

  /** Where the tip's centre will be at the wanted depth, m. */
  goal(wanted: number): Vec3 {
    return this.tipAt(bounded(wanted));
  }

  private tipAt(depth: number): Vec3 {
    return add(this.spot, scale(this.normal, this.tipRadius - depth));
  }

  get depth(): number {
    return this.depthNow;
  }
}
