// SPDX-License-Identifier: Apache-2.0
import { nearestOnTriangle, type Surface } from './surface';
import { add, dot, norm, pointOf, scale, sub, type Vec3 } from './vec';

/** The triangles, nine numbers each, that come within `reach` of a point. */
function trianglesNear(surface: Surface, point: Vec3, reach: number): [Vec3, Vec3, Vec3][] {
  const { now, mesh } = surface;
  const near = new Uint8Array(mesh.nodes);
  for (let n = 0; n < mesh.nodes; ++n) {
    const dx = now[3 * n] - point[0], dy = now[3 * n + 1] - point[1], dz = now[3 * n + 2] - point[2];
    near[n] = dx * dx + dy * dy + dz * dz < reach * reach ? 1 : 0;
  }
  const found: [Vec3, Vec3, Vec3][] = [];
  for (let t = 0; t < mesh.triangles.length; t += 3) {
    const [a, b, c] = [mesh.triangles[t], mesh.triangles[t + 1], mesh.triangles[t + 2]];
    if (near[a] || near[b] || near[c]) found.push([pointOf(now, a), pointOf(now, b), pointOf(now, c)]);
  }
  return found;
}

type Triangles = readonly [Vec3, Vec3, Vec3][];

/** How far a ball at `at` must move along n to clear each triangle by its own estimate, m: the largest of them. */
function missingAt(at: Vec3, n: Vec3, radius: number, triangles: Triangles): number {
  let missing = 0;
  for (const [a, b, c] of triangles) {
    const away = sub(at, nearestOnTriangle(at, a, b, c));
    const gap = norm(away);
    if (gap >= radius) continue;
    // Along n the distance grows by cos(away, n) per metre; taken as at least 0.2.
    const along = gap > 1e-9 ? dot(away, n) / gap : 1;
    missing = Math.max(missing, (radius - gap) / Math.max(along, 0.2));
  }
  return missing;
}

/** How far to move a ball along n until no surface is inside it: outward first, then back by bisection. */
function liftOff(centre: Vec3, n: Vec3, radius: number, triangles: Triangles): number {
  const missing = (lift: number): number => missingAt(add(centre, scale(n, lift)), n, radius, triangles);
  let [low, high] = [0, 0];
  for (let round = 0; round < 24; ++round) {
    const more = missing(high);
    if (more < 1e-7) break;
    low = high;
    high += more;
  }
  for (let round = 0; round < 10 && high - low > 1e-6; ++round) {
    const middle = 0.5 * (low + high);
    if (missing(middle) < 1e-7) high = middle;
    else low = middle;
  }
  return high;
}

/** Distance from a point to the displayed surface, m; infinity when none is within reach. */
export function gapTo(surface: Surface, point: Vec3, reach: number): number {
  let least = Infinity;
  for (const [a, b, c] of trianglesNear(surface, point, reach))
    least = Math.min(least, norm(sub(point, nearestOnTriangle(point, a, b, c))));
  return least;
}

/**
 * The centre at which a drawn tip rests on the displayed surface and is nowhere inside it.
 * @param touched  the displayed position of the touched point, the proxy, m
 * @param n        outward normal there
 * @param radius   of the tip, m
 */
export function restingCentre(surface: Surface, touched: Vec3, n: Vec3, radius: number): Vec3 {
  const edge = surface.size / Math.sqrt(surface.mesh.nodes); // about the length of an edge
  const triangles = trianglesNear(surface, touched, 4 * radius + 2 * edge);
  const start = add(touched, scale(n, radius));
  return add(start, scale(n, liftOff(start, n, radius, triangles)));
}
