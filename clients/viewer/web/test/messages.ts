// SPDX-License-Identifier: Apache-2.0
import type { Frame, Mesh } from '../src/protocol';

/** A ball of unit diagonals: an octahedron subdivided. @param radius m */
export function ballMesh(levels: number, radius: number): Mesh {
  let points: number[][] = [[1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1], [0, 0, -1]];
  let triangles = [[0, 2, 4], [2, 1, 4], [1, 3, 4], [3, 0, 4], [2, 0, 5], [1, 2, 5], [3, 1, 5], [0, 3, 5]];
  for (let level = 0; level < levels; ++level) {
    const middles = new Map<string, number>();
    const middle = (a: number, b: number): number => {
      const key = [Math.min(a, b), Math.max(a, b)].join();
      const known = middles.get(key);
      if (known !== undefined) return known;
      const sum = points[a].map((x, k) => x + points[b][k]);
      const size = Math.hypot(...sum);
      points = [...points, sum.map((x) => x / size)];
      middles.set(key, points.length - 1);
      return points.length - 1;
    };
    triangles = triangles.flatMap(([a, b, c]) => {
      const [p, q, r] = [middle(a, b), middle(b, c), middle(c, a)];
      return [[a, p, r], [p, b, q], [r, q, c], [p, q, r]];
    });
  }
  return {
    revision: 1,
    nodes: points.length,
    positions: Float32Array.from(points.flat().map((x) => radius * x)),
    triangles: Uint32Array.from(triangles.flat()),
    accessible: new Uint8Array(points.length).fill(1),
    clamped: new Uint8Array(points.length),
    regions: [],
  };
}

/** A frame of a mesh whose node displacements are u(X), m. */
export function frameOf(mesh: Mesh, u: (X: number[]) => number[], seq = 1): Frame {
  const scale = 1e-6;
  const values: number[] = [];
  for (let n = 0; n < mesh.nodes; ++n) values.push(...u([...mesh.positions.slice(3 * n, 3 * n + 3)]));
  return {
    seq, meshRevision: mesh.revision, nodes: mesh.nodes, sampleUs: 1000 * seq, sentUs: 1000 * seq + 10, surfaceSeq: seq, scale,
    displacement: Int16Array.from(values.map((v) => Math.round(v / scale))), tools: [], answers: [],
  };
}
