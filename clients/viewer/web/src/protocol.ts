// SPDX-License-Identifier: Apache-2.0
// Protocol palpate.viewer.v1 (../../PROTOCOL.md): little-endian binary, JSON text.
import type { Vec3 } from './vec';

export const SUBPROTOCOL = 'palpate.viewer.v1';
export const KIND_MESH = 1;
export const KIND_FRAME = 2;

export const STATE_FREE = 0;
export const STATE_SLIDE = 2;

/** The organ's rest surface. */
export interface Mesh {
  readonly revision: number;
  readonly nodes: number;
  readonly positions: Float32Array; // 3 nodes, m
  readonly triangles: Uint32Array; // 3 T, counter-clockwise from outside
  readonly accessible: Uint8Array; // nodes; 1: a tool may touch it
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
const ANSWER_BYTES = 32;

function expect(ok: boolean, what: string): void {
  if (!ok) throw new Error(`viewer sent a bad message: ${what}`);
}

/** u32 kind of a binary message. @throws Error when it is too short */
export function kindOf(data: ArrayBuffer): number {
  expect(data.byteLength >= 4, `${data.byteLength} bytes, expected at least 4`);
  return new DataView(data).getUint32(0, true);
}

/** @throws Error naming the wrong number */
export function decodeMesh(data: ArrayBuffer): Mesh {
  expect(data.byteLength >= 16, `mesh of ${data.byteLength} bytes, expected at least 16`);
  const head = new DataView(data);
  const nodes = head.getUint32(4, true);
  const count = head.getUint32(8, true);
  const wanted = 16 + 13 * nodes + 12 * count;
  expect(data.byteLength >= wanted && data.byteLength < wanted + 4, `mesh of ${data.byteLength} bytes, expected ${wanted}`);
  const positions = new Float32Array(data, 16, 3 * nodes);
  const triangles = new Uint32Array(data, 16 + 12 * nodes, 3 * count);
  for (const node of triangles) expect(node < nodes, `triangle node ${node} of ${nodes}`);
  expect(positions.every(Number.isFinite), 'a position is not finite');
  const accessible = new Uint8Array(data, 16 + 12 * nodes + 12 * count, nodes);
  return { revision: head.getUint32(12, true), nodes, positions, triangles, accessible };
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
