// SPDX-License-Identifier: Apache-2.0
// Protocol palpate.viewer.v1 (../../PROTOCOL.md): little-endian binary, JSON text.
import type { Vec3 } from './vec';

export const SUBPROTOCOL = 'palpate.viewer.v1';
export const KIND_MESH = 1;
export const KIND_FRAME = 2;

export const STATE_FREE = 0;
export const STATE_SLIDE = 2;

/** Nodes at rest and triangles between them. */
export interface Shape {
  readonly nodes: number;
  readonly positions: Float32Array; // 3 nodes, m
  readonly triangles: Uint32Array; // 3 T, counter-clockwise from outside
}

/** The organ's rest surface. */
export interface Mesh extends Shape {
  readonly revision: number;
  readonly accessible: Uint8Array; // nodes; 1: a tool may touch it
  readonly clamped: Uint8Array; // nodes; 1: does not move
  readonly regions: readonly Shape[]; // where each ends inside the organ; without triangles: the one round the others
}

export interface Tool {
  readonly id: number;
  readonly state: number;
  readonly flags: number;
  readonly mine: boolean; // this page drives it
  readonly tip: Vec3; // tip centre of the answered pose, m
  readonly proxy: Vec3; // current position of the touched point, m
  readonly anchor: Vec3; // the touched point at rest, m
  readonly force: Vec3; // on the tool, N
  readonly penetration: number; // m
  readonly domainRadius: number; // m
}

/** One answer of the server to one tool; the strip chart shows them. */
export interface Answer {
  readonly toolId: number;
  readonly flags: number;
  readonly tUs: number; // viewer's clock, us
  readonly force: number; // N
  readonly penetration: number; // m
  readonly wakeupUs: number; // lateness of the tick's wake-up, us
  readonly stiffness: number; // felt along the normal, N/m; 0: free
  readonly forceVector: Vec3; // on the tool, N
  readonly tip: Vec3; // centre of the tip in the newest pose known then, m
}

export interface Frame {
  readonly seq: number;
  readonly meshRevision: number;
  readonly nodes: number; // 0: no surface in this frame
  readonly sampleUs: number; // viewer's clock when the surface came by DDS, us
  readonly sentUs: number;
  readonly surfaceSeq: number;
  readonly scale: number; // m per unit of displacement
  readonly displacement: Int16Array; // 3 nodes
  readonly tools: readonly Tool[];
  readonly answers: readonly Answer[];
}

const FRAME_HEAD = 56;
const TOOL_BYTES = 72;
const ANSWER_BYTES = 56;

function expect(ok: boolean, what: string): void {
  if (!ok) throw new Error(`viewer sent a bad message: ${what}`);
}

/** u32 kind of a binary message. @throws Error when it is too short */
export function kindOf(data: ArrayBuffer): number {
  expect(data.byteLength >= 4, `${data.byteLength} bytes, expected at least 4`);
  return new DataView(data).getUint32(0, true);
}

/** Takes a binary message apart, from its beginning. @throws Error when it is too short */
class Parts {
  at = 0;
  constructor(private readonly data: ArrayBuffer) {}

  whole(count: number): Uint32Array {
    return new Uint32Array(this.data, this.take(4 * count), count);
  }

  bytes(count: number): Uint8Array {
    return new Uint8Array(this.data, this.take(count), count);
  }

  shape(nodes: number, count: number): Shape {
    const positions = new Float32Array(this.data, this.take(12 * nodes), 3 * nodes);
    const triangles = this.whole(3 * count);
    for (const node of triangles) expect(node < nodes, `triangle node ${node} of ${nodes}`);
    expect(positions.every(Number.isFinite), 'a position is not finite');
    return { nodes, positions, triangles };
  }

  private take(bytes: number): number {
    const from = this.at;
    this.at += bytes;
    expect(this.at <= this.data.byteLength, `mesh of ${this.data.byteLength} bytes, expected at least ${this.at}`);
    return from;
  }
}

/** @throws Error naming the wrong number */
export function decodeMesh(data: ArrayBuffer): Mesh {
  const parts = new Parts(data);
  const [, nodes, count, revision, regions] = parts.whole(5);
  const shape = parts.shape(nodes, count);
  const accessible = parts.bytes(nodes);
  const clamped = parts.bytes(nodes);
  parts.bytes(-parts.at & 3);
  const inside: Shape[] = [];
  for (let r = 0; r < regions; ++r) {
    const [n, t] = parts.whole(2);
    inside.push(parts.shape(n, t));
  }
  expect(parts.at === data.byteLength, `mesh of ${data.byteLength} bytes, expected ${parts.at}`);
  return { ...shape, revision, accessible, clamped, regions: inside };
}

function vectorAt(view: DataView, at: number): Vec3 {
  return [view.getFloat32(at, true), view.getFloat32(at + 4, true), view.getFloat32(at + 8, true)];
}

function toolAt(view: DataView, at: number): Tool {
  return {
    id: view.getUint32(at, true),
    state: view.getUint32(at + 4, true),
    flags: view.getUint32(at + 8, true),
    mine: view.getUint32(at + 12, true) === 1,
    tip: vectorAt(view, at + 16),
    proxy: vectorAt(view, at + 28),
    anchor: vectorAt(view, at + 40),
    force: vectorAt(view, at + 52),
    penetration: view.getFloat32(at + 64, true),
    domainRadius: view.getFloat32(at + 68, true),
  };
}

function answerAt(view: DataView, at: number): Answer {
  return {
    toolId: view.getUint32(at, true),
    flags: view.getUint32(at + 4, true),
    tUs: view.getFloat64(at + 8, true),
    force: view.getFloat32(at + 16, true),
    penetration: view.getFloat32(at + 20, true),
    wakeupUs: view.getFloat32(at + 24, true),
    stiffness: view.getFloat32(at + 28, true),
    forceVector: vectorAt(view, at + 32),
    tip: vectorAt(view, at + 44),
  };
}

/** The displacement is a view of `data`, not a copy. @throws Error naming the wrong number */
export function decodeFrame(data: ArrayBuffer): Frame {
  expect(data.byteLength >= FRAME_HEAD, `frame of ${data.byteLength} bytes, expected at least ${FRAME_HEAD}`);
  const view = new DataView(data);
  const nodes = view.getUint32(12, true);
  const tools = view.getUint32(40, true);
  const answers = view.getUint32(44, true);
  const toolsAt = FRAME_HEAD + 4 * Math.ceil((6 * nodes) / 4);
  const answersAt = toolsAt + TOOL_BYTES * tools;
  const wanted = answersAt + ANSWER_BYTES * answers;
  expect(data.byteLength === wanted, `frame of ${data.byteLength} bytes, expected ${wanted}`);
  return {
    seq: view.getUint32(4, true),
    meshRevision: view.getUint32(8, true),
    nodes,
    sampleUs: view.getFloat64(16, true),
    sentUs: view.getFloat64(24, true),
    surfaceSeq: Number(view.getBigUint64(32, true)),
    scale: view.getFloat32(48, true),
    displacement: new Int16Array(data, FRAME_HEAD, 3 * nodes),
    tools: Array.from({ length: tools }, (_, i) => toolAt(view, toolsAt + i * TOOL_BYTES)),
    answers: Array.from({ length: answers }, (_, i) => answerAt(view, answersAt + i * ANSWER_BYTES)),
  };
}
