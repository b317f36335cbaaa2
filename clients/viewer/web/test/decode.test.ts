// SPDX-License-Identifier: Apache-2.0
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { joined, HandOver, type Parcel } from '../src/hand_over';
import { decodeFrame, decodeMesh, kindOf } from '../src/protocol';
import { ballMesh, frameOf } from './messages';

// Three nodes and a triangle, offsets as PROTOCOL.md has them; two regions, the second a triangle of its own.
function meshMessage(): ArrayBuffer {
  const data = new ArrayBuffer(20 + 36 + 12 + 8 + 8 + 8 + 36 + 12);
  new Uint32Array(data, 0, 5).set([1, 3, 1, 7, 2]);
  new Float32Array(data, 20, 9).set([0, 0, 0, 1, 0, 0, 0, 1, 0]);
  new Uint32Array(data, 56, 3).set([0, 1, 2]);
  new Uint8Array(data, 68, 6).set([1, 0, 1, 0, 1, 0]);
  new Uint32Array(data, 84, 2).set([3, 1]);
  new Float32Array(data, 92, 9).set([0, 0, 5, 1, 0, 5, 0, 1, 5]);
  new Uint32Array(data, 128, 3).set([2, 1, 0]);
  return data;
}

// One node, one tool, one answer, offsets as PROTOCOL.md has them: 56 + 8 (6 and padding), 72, 56.
function frameMessage(): ArrayBuffer {
  const data = new ArrayBuffer(56 + 8 + 72 + 56);
  const view = new DataView(data);
  [2, 9, 7, 1].forEach((x, i) => view.setUint32(4 * i, x, true));
  view.setFloat64(16, 123.5, true);
  view.setFloat64(24, 124.5, true);
  view.setBigUint64(32, 77n, true);
  view.setUint32(40, 1, true);
  view.setUint32(44, 1, true);
  view.setFloat32(48, 0.5, true);
  [3, -4, 5].forEach((x, i) => view.setInt16(56 + 2 * i, x, true));
  [2, 1, 33, 1].forEach((x, i) => view.setUint32(64 + 4 * i, x, true));
  Array.from({ length: 14 }, (_, i) => view.setFloat32(80 + 4 * i, i + 1, true));
  [2, 33].forEach((x, i) => view.setUint32(136 + 4 * i, x, true));
  view.setFloat64(144, 99.25, true);
  [1.5, 0.25, 30, 400, 1, 2, 3, 4, 5, 6].forEach((x, i) => view.setFloat32(152 + 4 * i, x, true));
  return data;
}

test('a mesh is read as it was written', () => {
  const mesh = decodeMesh(meshMessage());
  assert.equal(kindOf(meshMessage()), 1);
  assert.deepEqual([mesh.revision, mesh.nodes, [...mesh.triangles]], [7, 3, [0, 1, 2]]);
  assert.deepEqual([[...mesh.accessible], [...mesh.clamped]], [[1, 0, 1], [0, 1, 0]]);
  assert.deepEqual([...mesh.positions], [0, 0, 0, 1, 0, 0, 0, 1, 0]);
  assert.deepEqual(mesh.regions.map(({ nodes, triangles }) => [nodes, ...triangles]), [[0], [3, 2, 1, 0]]);
  assert.deepEqual([...mesh.regions[1].positions], [0, 0, 5, 1, 0, 5, 0, 1, 5]);
});

test('a mesh with a triangle of no node, no number or another length is refused, with the number', () => {
  for (const at of [56, 128]) {
    const wrong = meshMessage();
    new Uint32Array(wrong, at, 1)[0] = 3;
    assert.throws(() => decodeMesh(wrong), /node 3 of 3/);
  }
  for (const at of [20, 92]) {
    const nan = meshMessage();
    new Float32Array(nan, at, 1)[0] = NaN;
    assert.throws(() => decodeMesh(nan), /not finite/);
  }
  for (const length of [3, 16, 60, 70, 90, 139]) assert.throws(() => decodeMesh(meshMessage().slice(0, length)), /bytes/);
  const long = new Uint8Array(144);
  long.set(new Uint8Array(meshMessage()));
  assert.throws(() => decodeMesh(long.buffer), /144 bytes, expected 140/);
  const many = meshMessage();
  new Uint32Array(many, 16, 1)[0] = 0xffffffff; // regions
  assert.throws(() => decodeMesh(many), /140 bytes, expected at least 148/);
});

test('a frame is read as it was written', () => {
  const frame = decodeFrame(frameMessage());
  assert.deepEqual([frame.seq, frame.meshRevision, frame.nodes, frame.surfaceSeq, frame.scale], [9, 7, 1, 77, 0.5]);
  assert.deepEqual([frame.sampleUs, frame.sentUs, [...frame.displacement]], [123.5, 124.5, [3, -4, 5]]);
  assert.deepEqual(frame.tools[0], {
    id: 2, state: 1, flags: 33, mine: true, tip: [1, 2, 3], proxy: [4, 5, 6], anchor: [7, 8, 9], force: [10, 11, 12], penetration: 13, domainRadius: 14,
  });
  assert.deepEqual(frame.answers[0], { toolId: 2, flags: 33, tUs: 99.25, force: 1.5, penetration: 0.25, wakeupUs: 30, stiffness: 400,
    forceVector: [1, 2, 3], tip: [4, 5, 6] });
});

test('a frame of another length is refused', () => {
  for (const length of [3, 55, 60, 167]) assert.throws(() => decodeFrame(frameMessage().slice(0, length)), new RegExp(`${length} bytes`));
});

const got = { bytes: 10, delayMs: 1 };

/** A hand-over, and what it has given. */
function handing() {
  const given: Parcel[] = [];
  return { mesh: ballMesh(0, 1), given, over: new HandOver((parcel) => given.push(parcel)) };
}

test('a page that is busy gets one frame later, with the newest surface and every answer', () => {
  const { mesh, given, over } = handing();
  const answer = (tUs: number) => ({ toolId: 0, flags: 0, tUs, force: 1, penetration: 0, wakeupUs: 0, stiffness: 0 });
  for (const seq of [1, 2, 3]) over.add({ ...frameOf(mesh, () => [seq * 1e-3, 0, 0], seq), answers: [answer(seq)] }, got);
  over.add({ ...frameOf(mesh, () => [0, 0, 0], 4), nodes: 0, displacement: new Int16Array(0), answers: [answer(4)] }, got);
  assert.equal(given.length, 1);
  over.taken();
  assert.equal(given.length, 2);
  assert.deepEqual(given[1].frame.answers.map((a) => a.tUs), [2, 3, 4]);
  assert.deepEqual([given[1].frame.seq, given[1].frame.surfaceSeq, given[1].frame.nodes, given[1].received.length], [4, 3, 6, 3]);
  assert.equal(joined(given[1], { ...frameOf(mesh, () => [0, 0, 0], 5) }, got).frame.surfaceSeq, 5);
});

test('what waited when the server or the line went is never handed over, what comes after it is', () => {
  const { mesh, given, over } = handing();
  for (const seq of [1, 2]) over.add(frameOf(mesh, () => [seq * 1e-3, 0, 0], seq), got);
  over.clear();
  over.taken();
  assert.deepEqual(given.map((parcel) => parcel.frame.seq), [1]);
  over.add(frameOf(mesh, () => [0, 0, 0], 3), got);
  assert.deepEqual(given.map((parcel) => [parcel.frame.seq, parcel.received.length]), [[1, 1], [3, 1]]);
});

test('a page that is busy through all of it gets no frame of the connection before', () => {
  const { mesh, given, over } = handing();
  for (const seq of [1, 2]) over.add(frameOf(mesh, () => [seq * 1e-3, 0, 0], seq), got);
  over.clear();
  over.add({ ...frameOf(mesh, () => [0, 0, 0], 3), nodes: 0, displacement: new Int16Array(0) }, got);
  over.taken();
  assert.deepEqual(given.map((parcel) => [parcel.frame.seq, parcel.frame.nodes]), [[1, 6], [3, 0]]);
});
