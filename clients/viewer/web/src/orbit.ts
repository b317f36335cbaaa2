// SPDX-License-Identifier: Apache-2.0
import { add, cross, scale, unit, type Vec3 } from './vec';

/** A camera that circles a point; z is up. Angles in radians. */
export class Orbit {
  azimuth = -1.05;
  elevation = 0.5;
  distance = 1;
  target: Vec3 = [0, 0, 0];
  private home = { azimuth: this.azimuth, elevation: this.elevation, distance: 1, target: this.target };
  changed = true;

  /** Frames a thing of that size. @param fov vertical opening, rad @param aspect width over height */
  frame(centre: Vec3, size: number, fov: number, aspect: number): void {
    const opening = 2 * Math.atan(Math.tan(fov / 2) * Math.min(1, aspect));
    this.home = { ...this.home, target: centre, distance: (0.41 * size) / Math.sin(opening / 2) };
    this.reset();
  }

  reset(): void {
    Object.assign(this, this.home);
    this.changed = true;
  }

  turn(azimuth: number, elevation: number): void {
    this.azimuth += azimuth;
    this.elevation = Math.min(1.5, Math.max(-1.5, this.elevation + elevation));
    this.changed = true;
  }

  zoom(factor: number): void {
    const { distance } = this.home;
    this.distance = Math.min(4 * distance, Math.max(0.2 * distance, this.distance * factor));
    this.changed = true;
  }

  /** Moves the scene by a share of the picture's height, right and up. */
  pan(right: number, up: number, fov: number): void {
    const height = 2 * this.distance * Math.tan(fov / 2);
    const { right: x, up: y } = this.axes();
    const limit = 1.5 * this.home.distance;
    const moved = add(this.target, add(scale(x, -right * height), scale(y, -up * height)));
    if (Math.hypot(...moved.map((m, i) => m - this.home.target[i])) < limit) this.target = moved;
    this.changed = true;
  }

  get position(): Vec3 {
    return add(this.target, scale(this.outward(), this.distance));
  }

  private axes(): { right: Vec3; up: Vec3 } {
    const right = unit(cross([0, 0, 1], this.outward()), [1, 0, 0]);
    return { right, up: cross(this.outward(), right) };
  }

  private outward(): Vec3 {
    const c = Math.cos(this.elevation);
    return [c * Math.cos(this.azimuth), c * Math.sin(this.azimuth), Math.sin(this.elevation)];
  }
}
