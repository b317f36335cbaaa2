// SPDX-License-Identifier: Apache-2.0
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { endOfModel } from '../src/depth_slider';
import { LastPress, type Pressed } from '../src/last_press';
import { STATE_FREE, type Answer, type Frame, type Mesh, type Tool } from '../src/protocol';
import { adviceOf, Contact, noduleOf, scoreOf } from '../src/training';
import type { Vec3 } from '../src/vec';
import { ballMesh, frameOf } from './messages';

const R = 0.05;
const answer = (tUs: number, force: number): Answer =>
  ({ toolId: 3, flags: 1, tUs, force, penetration: force / 1000, wakeupUs: 0, stiffness: 400, forceVector: [0, 0, force], tip: [0, 0, R] });
const answers = (fromUs: number, ms: number, force: number): Answer[] => Array.from({ length: ms + 1 }, (_, i) => answer(fromUs + 1000 * i, force));
const tool = (state: number, anchor: Vec3, mine = true): Tool =>
  ({ id: 3, state, flags: 1, mine, tip: [0, 0, R], proxy: [0, 0, R - 0.001], anchor, force: [0, 0, 1], penetration: 0.002, domainRadius: 0.003 });

/** The ball with a region of a ball's shape under its top. */
function withNodule(): Mesh {
  const mesh = ballMesh(3, R);
  const small = ballMesh(1, 0.01);
  const nodule = { nodes: small.nodes, triangles: small.triangles, positions: small.positions.map((x, i) => (i % 3 === 2 ? x + 0.03 : x)) };
  return { ...mesh, regions: [{ nodes: 0, positions: new Float32Array(0), triangles: new Uint32Array(0) }, nodule] };
}

test('keeping below a force scores the share of the contact below it; hardly touching and pauses do not count', () => {
  const contact = new Contact(2);
  contact.add(answers(0, 3000, 1));
  contact.add(answers(4_000_000, 1000, 3)); // the second between is no contact
  contact.add(answers(9_000_000, 5000, 0.1));
  assert.ok(Math.abs(contact.seconds - 4) < 1e-6 && Math.abs(contact.above - 1) < 1e-6, `${contact.seconds} s, ${contact.above} s`);
  assert.deepEqual([contact.points, contact.strongest], [75, 3]);
  assert.equal(new Contact(2).points, 0);
});

test('a nodule is found right above it, less the farther off, and less with force', () => {
  const mesh = withNodule();
  const nodule = noduleOf(mesh);
  assert.ok(nodule);
  const soft = new Contact(2), hard = new Contact(2);
  soft.add(answers(0, 1000, 1));
  hard.add(answers(0, 1000, 5));
  const points = (spot: Vec3, contact: Contact): number => scoreOf(mesh, nodule, spot, contact).points;
  assert.equal(points([0, 0, R], soft), 100);
  assert.equal(points([0, 0, R], hard), 50);
  const beside = points([0.02, 0, Math.sqrt(R * R - 4e-4)], soft);
  assert.equal(beside, 32); // 20.4 of 30 mm
  assert.equal(points([0, 0, -R], soft), 0);
});

test('an organ of one material has nothing to be found', () => {
  assert.equal(noduleOf(ballMesh(2, R)), undefined);
});

test('a press is told when it begins and ends, with its largest force and where it was; another page\'s is not', () => {
  const told: (string | Pressed)[] = [];
  const press = new LastPress(() => told.push('began'), (pressed) => told.push(pressed));
  const frame = (tools: Tool[], some: Answer[]): Frame => ({ ...frameOf(ballMesh(1, R), () => [0, 0, 0]), tools, answers: some });
  press.frame(frame([tool(1, [0, 0, R], false)], [answer(1, 9)]));
  assert.deepEqual(told, []);
  press.frame(frame([tool(1, [0, 0, R])], [answer(1, 2), answer(2, 4)]));
  press.frame(frame([tool(2, [0.01, 0, R])], [answer(3, 1)]));
  assert.deepEqual(told, ['began']);
  press.frame(frame([], []));
  assert.deepEqual(told, ['began', { force: 4, depth: 0.004, spot: [0.01, 0, R] }]);
  press.end();
  assert.equal(told.length, 2);
  assert.equal(press.newest?.force, 4);
});

test('the answers of the frame that shows the tool free, or no more, are of the press', () => {
  for (const last of [[tool(STATE_FREE, [0, 0, R])], []]) {
    const told: Pressed[] = [];
    const press = new LastPress(() => {}, (pressed) => told.push(pressed));
    const frame = (tools: Tool[], some: Answer[]): Frame => ({ ...frameOf(ballMesh(1, R), () => [0, 0, 0]), tools, answers: some });
    press.frame(frame([tool(1, [0, 0, R])], [answer(1, 2)]));
    assert.equal(press.frame(frame(last, [answer(2, 5), answer(3, 0)])).length, 2);
    assert.deepEqual(told, [{ force: 5, depth: 0.005, spot: [0, 0, R] }]);
    press.frame(frame([], [answer(4, 9)]));
    assert.equal(press.newest?.force, 5, 'later answers are another\'s');
  }
});

test('who names a place is told to press, or to press harder, until a press counts', () => {
  const contact = new Contact(2);
  assert.match(adviceOf(contact) ?? '', /Press on the organ first/);
  contact.add(answers(0, 1000, 0.3));
  assert.match(adviceOf(contact) ?? '', /Press harder: with more than 0\.4 N/);
  contact.add(answers(2_000_000, 100, 0.5));
  assert.equal(adviceOf(contact), undefined);
});

test('the model ends as deep as d_max of the touched point', () => {
  assert.equal(endOfModel(tool(1, [0, 0, R])), 0.003);
  assert.ok(Number.isNaN(endOfModel({ ...tool(1, [0, 0, R]), penetration: 1e-4 })), 'hardly touched');
  assert.ok(Number.isNaN(endOfModel({ ...tool(1, [0, 0, R]), domainRadius: 0 })));
});
