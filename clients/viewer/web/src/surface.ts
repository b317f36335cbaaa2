// SPDX-License-Identifier: Apache-2.0
import type { Frame, Mesh } from './protocol';
import { add, dot, norm, pointOf, scale, sub, unit, type Vec3 } from './vec';

export interface Hit {
  readonly triangle: number;
  readonly weights: Vec3; // barycentric
  readonly distance: number; // along the ray
}

/** The organ's surface, at rest and displaced. No drawing here. */
export class Surface {
  readonly rest: Float32Array;
  readonly now: Float32Array;
  readonly normals: Float32Array;
  readonly restNormals: Float32Array;
  readonly displaced: Float32Array; // |u| of each node, m
  readonly centre: Vec3;
  readonly size: number; // diagonal of the box, m
  largest = 0; // of displaced, m
  private shownSeq = -1;

  constructor(readonly mesh: Mesh) {
    this.rest = mesh.positions.slice();
    this.now = mesh.positions.slice();
    this.normals = new Float32Array(3 * mesh.nodes);
    this.restNormals = new Float32Array(3 * mesh.nodes);
    this.displaced = new Float32Array(mesh.nodes);
    writeNormals(this.rest, mesh.triangles, this.restNormals);
    this.normals.set(this.restNormals);
    const { low, high } = boxOf(this.rest);
    this.centre = scale(add(low, high), 0.5);
    this.size = norm(sub(high, low));
  }

  /** @return whether anything moved; a frame of another mesh, without a surface, or with the same field moves nothing */
  show(frame: Frame): boolean {
    const { nodes, meshRevision, displacement: u, scale: unitM } = frame;
    if (nodes !== this.mesh.nodes || meshRevision !== this.mesh.revision) return false;
    if (frame.surfaceSeq === this.shownSeq) return false;
    this.shownSeq = frame.surfaceSeq;
    let moved = false;
    for (let i = 0; i < u.length; ++i) {
      const x = this.rest[i] + unitM * u[i];
      if (Math.abs(x - this.now[i]) > 1e-7) moved = true;
      this.now[i] = x;
    }
    if (!moved) return false;
    this.largest = 0;
    for (let n = 0; n < nodes; ++n) {
      const size = unitM * Math.hypot(u[3 * n], u[3 * n + 1], u[3 * n + 2]);
      this.displaced[n] = size;
      if (size > this.largest) this.largest = size;
    }
    writeNormals(this.now, this.mesh.triangles, this.normals);
    return true;
  }

  /** Back to the shape at rest. */
  calm(): void {
    this.now.set(this.rest);
    this.normals.set(this.restNormals);
    this.displaced.fill(0);
    this.largest = 0;
    this.shownSeq = -1;
  }

  /** The nearest place where a ray enters the surface from outside, at rest or displaced. */
  hit(origin: Vec3, direction: Vec3, positions: Float32Array = this.now): Hit | undefined {
    const found = new Float64Array(3); // distance, u, v
    let best: Hit | undefined;
    const { triangles } = this.mesh;
    for (let t = 0; t < triangles.length / 3; ++t) {
      if (!enters(origin, direction, positions, triangles, t, found)) continue;
      const [distance, u, v] = found;
      if (!best || distance < best.distance) best = { triangle: t, weights: [1 - u - v, u, v], distance };
    }
    return best;
  }

  /** Interpolates node values (3 each) at a hit. */
  at(values: Float32Array, hit: Hit): Vec3 {
    const corner = (k: number): Vec3 => pointOf(values, this.mesh.triangles[3 * hit.triangle + k]);
    return add(add(scale(corner(0), hit.weights[0]), scale(corner(1), hit.weights[1])), scale(corner(2), hit.weights[2]));
  }

  /** Whether a tool may touch there: all three corners are accessible. */
  accessibleAt(hit: Hit): boolean {
    return [0, 1, 2].every((k) => this.mesh.accessible[this.mesh.triangles[3 * hit.triangle + k]] !== 0);
  }

  /** Whether the clamp holds it: a corner is clamped. */
  clampedAt(hit: Hit): boolean {
    return [0, 1, 2].some((k) => this.mesh.clamped[this.mesh.triangles[3 * hit.triangle + k]] !== 0);
  }

  /** Outward normal of the displayed surface at the node nearest to a point. */
  normalNear(point: Vec3): Vec3 {
    let best = 0;
    let least = Infinity;
    for (let n = 0; n < this.mesh.nodes; ++n) {
      const d = norm(sub(pointOf(this.now, n), point));
      if (d < least) [least, best] = [d, n];
    }
    return pointOf(this.normals, best);
  }
}

function boxOf(positions: Float32Array): { low: Vec3; high: Vec3 } {
  const low: [number, number, number] = [Infinity, Infinity, Infinity];
  const high: [number, number, number] = [-Infinity, -Infinity, -Infinity];
  for (let i = 0; i < positions.length; ++i) {
    low[i % 3] = Math.min(low[i % 3], positions[i]);
    high[i % 3] = Math.max(high[i % 3], positions[i]);
  }
  return { low, high };
}

/**
 * Moeller and Trumbore, "Fast, minimum storage ray-triangle intersection" (1997), front faces only. Plain numbers,
 * because each move of a pointer tests thousands of triangles.
 */
function enters(o: Vec3, d: Vec3, x: Float32Array, triangles: Uint32Array, t: number, out: Float64Array): boolean {
  const a = 3 * triangles[3 * t], b = 3 * triangles[3 * t + 1], c = 3 * triangles[3 * t + 2];
  const e1x = x[b] - x[a], e1y = x[b + 1] - x[a + 1], e1z = x[b + 2] - x[a + 2];
  const e2x = x[c] - x[a], e2y = x[c + 1] - x[a + 1], e2z = x[c + 2] - x[a + 2];
  const px = d[1] * e2z - d[2] * e2y, py = d[2] * e2x - d[0] * e2z, pz = d[0] * e2y - d[1] * e2x;
  const det = e1x * px + e1y * py + e1z * pz;
  if (det <= 0) return false; // seen from behind
  const sx = o[0] - x[a], sy = o[1] - x[a + 1], sz = o[2] - x[a + 2];
  const u = (sx * px + sy * py + sz * pz) / det;
  if (u < 0 || u > 1) return false;
  const qx = sy * e1z - sz * e1y, qy = sz * e1x - sx * e1z, qz = sx * e1y - sy * e1x;
  const v = (d[0] * qx + d[1] * qy + d[2] * qz) / det;
  if (v < 0 || u + v > 1) return false;
  out[0] = (e2x * qx + e2y * qy + e2z * qz) / det;
  out[1] = u;
  out[2] = v;
  return out[0] > 0;
}

/** Normals of the nodes, weighted by the triangles' areas. */
export function writeNormals(x: Float32Array, triangles: Uint32Array, out: Float32Array): void {
  out.fill(0);
  for (let t = 0; t < triangles.length; t += 3) {
    const a = 3 * triangles[t];
    const b = 3 * triangles[t + 1];
    const c = 3 * triangles[t + 2];
    const e1x = x[b] - x[a], e1y = x[b + 1] - x[a + 1], e1z = x[b + 2] - x[a + 2];
    const e2x = x[c] - x[a], e2y = x[c + 1] - x[a + 1], e2z = x[c + 2] - x[a + 2];
    const nx = e1y * e2z - e1z * e2y, ny = e1z * e2x - e1x * e2z, nz = e1x * e2y - e1y * e2x;
    for (const k of [a, b, c]) {
      out[k] += nx;
      out[k + 1] += ny;
      out[k + 2] += nz;
    }
  }
  for (let i = 0; i < out.length; i += 3) {
    const size = Math.hypot(out[i], out[i + 1], out[i + 2]) || 1;
    out[i] /= size;
    out[i + 1] /= size;
    out[i + 2] /= size;
  }
}

/** The point of triangle abc nearest to p (Ericson, Real-Time Collision Detection, 2005, section 5.1.5). */
export function nearestOnTriangle(p: Vec3, a: Vec3, b: Vec3, c: Vec3): Vec3 {
  const ab = sub(b, a), ac = sub(c, a), ap = sub(p, a);
  const d1 = dot(ab, ap), d2 = dot(ac, ap);
  if (d1 <= 0 && d2 <= 0) return a;
  const bp = sub(p, b);
  const d3 = dot(ab, bp), d4 = dot(ac, bp);
  if (d3 >= 0 && d4 <= d3) return b;
  const vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return add(a, scale(ab, d1 / (d1 - d3)));
  const cp = sub(p, c);
  const d5 = dot(ab, cp), d6 = dot(ac, cp);
  if (d6 >= 0 && d5 <= d6) return c;
  const vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return add(a, scale(ac, d2 / (d2 - d6)));
  const va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 >= d3 && d5 >= d6) return add(b, scale(sub(c, b), (d4 - d3) / (d4 - d3 + d5 - d6)));
  const whole = va + vb + vc;
  return add(a, add(scale(ab, vb / whole), scale(ac, vc / whole)));
}

/** Smooth outward normal at a hit, at rest. */
export const restNormalAt = (surface: Surface, hit: Hit): Vec3 => unit(surface.at(surface.restNormals, hit));
