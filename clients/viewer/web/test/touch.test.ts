// SPDX-License-Identifier: Apache-2.0
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { FeltMap } from '../src/felt';
import { Orbit } from '../src/orbit';
import { DEEPEST, later, Press } from '../src/press';
import { gapTo, restingCentre } from '../src/resting';
import { Surface } from '../src/surface';
import { norm, scale, sub, unit, type Vec3 } from '../src/vec';
import { ballMesh, frameOf } from './messages';

const R = 0.05;
const TIP = 0.005;
const ball = (): Surface => new Surface(ballMesh(4, R));
const down = (x = 0, y = 0): { origin: Vec3; direction: Vec3 } => ({ origin: [x, y, 1], direction: [0, 0, -1] });
const near = (a: Vec3, b: Vec3, least: number): void => assert.ok(norm(sub(a, b)) < least, `${a} is not ${b}`);

/** A dent of that depth at the top, about as wide as the tip. */
const dent = (depth: number) => (X: number[]): number[] => [0, 0, -depth * Math.exp(-((X[0] ** 2 + X[1] ** 2) / 0.008 ** 2)) * (X[2] > 0 ? 1 : 0)];

test('a ray meets the ball in front, not behind, and misses beside it', () => {
  const surface = ball();
  const hit = surface.hit([0.01, 0, 1], [0, 0, -1]);
  assert.ok(hit);
  near(surface.at(surface.now, hit), [0.01, 0, Math.sqrt(R * R - 1e-4)], 2e-4);
  assert.equal(surface.hit([0.06, 0, 1], [0, 0, -1]), undefined);
  assert.equal(surface.hit([0, 0, 0], [0, 0, -1]), undefined); // from inside there are only backs
});

test('a frame moves the nodes, the same again moves nothing, one of another mesh neither', () => {
  const surface = ball();
  const frame = frameOf(surface.mesh, () => [0.002, 0, 0]);
  assert.equal(surface.show(frame), true);
  assert.ok(Math.abs(surface.largest - 0.002) < 1e-6 && Math.abs(surface.now[0] - surface.rest[0] - 0.002) < 1e-6);
  assert.equal(surface.show(frame), false);
  assert.equal(surface.show({ ...frame, meshRevision: 2, surfaceSeq: 9 }), false);
  surface.calm();
  assert.deepEqual([surface.largest, surface.now[0]], [0, surface.rest[0]]);
});

test('normals of a ball point outward', () => {
  const surface = ball();
  for (let n = 0; n < surface.mesh.nodes; n += 17) {
    const X: Vec3 = [surface.rest[3 * n], surface.rest[3 * n + 1], surface.rest[3 * n + 2]];
    near([surface.normals[3 * n], surface.normals[3 * n + 1], surface.normals[3 * n + 2]], unit(X), 0.04); // of facets
  }
});

test('a tip rests in a dent: it touches, and is nowhere inside', () => {
  for (const depth of [0, 0.002, 0.006, 0.012]) {
    const surface = ball();
    surface.show(frameOf(surface.mesh, dent(depth)));
    const touched: Vec3 = [0, 0, R - depth];
    const centre = restingCentre(surface, touched, [0, 0, 1], TIP);
    const gap = gapTo(surface, centre, 0.05) - TIP;
    assert.ok(gap > -1e-6 && gap < 3e-4, `dent of ${depth} m: gap ${gap} m`);
    assert.ok(depth < 0.012 || centre[2] > touched[2] + TIP + 1e-4, 'a dent narrower than the tip holds it up');
  }
});

test('a press goes down to its depth and no deeper, and comes up again', () => {
  const press = Press.begin(ball(), down(), TIP, 0);
  assert.ok(press);
  near(press.target(0, 0.004), [0, 0, R + TIP + 0.001], 1e-4); // from just above
  let z = 1;
  for (let t = 10; t <= 1000; t += 10) z = press.target(t, 0.004)[2];
  assert.ok(Math.abs(z - (R + TIP - 0.004)) < 1e-4);
  for (let t = 1010; t <= 1500; t += 10) z = press.target(t, 0.001)[2];
  assert.ok(Math.abs(z - (R + TIP - 0.001)) < 1e-4);
  for (let t = 1510; t <= 5000; t += 10) z = press.target(t, 1)[2];
  assert.ok(Math.abs(z - (R + TIP - DEEPEST)) < 1e-4);
});

test('a press that was interrupted for long does not jump', () => {
  const press = Press.begin(ball(), down(), TIP, 0);
  const before = press?.target(10, 0.01);
  const after = press?.target(10_000, 0.01);
  assert.ok(before && after && norm(sub(before, after)) < 0.0013);
});

test('sliding follows the surface at rest, whatever its dents; beside the organ it stays', () => {
  const surface = ball();
  surface.show(frameOf(surface.mesh, dent(0.006)));
  const press = Press.begin(surface, down(), TIP, 0);
  assert.ok(press);
  assert.equal(press.slideTo(down(0.03, 0)), true);
  const target = press.target(0, 0);
  near(target, scale(unit(target), R + TIP + 0.001), 2e-4); // of facets
  near(unit(target), unit([0.03, 0, 0.04]), 0.01);
  assert.equal(press.slideTo(down(0.2, 0)), false);
  near(press.target(0, 0), target, 1e-9);
});

test('pulling stays in the plane of the touch', () => {
  const press = Press.begin(ball(), down(), TIP, 0);
  assert.equal(press?.pullTo(down(0.02, 0.01)), true);
  near(press?.target(0, 0) ?? [0, 0, 0], [0.02, 0.01, R + TIP + 0.001], 3e-4);
});

test('where the organ is clamped nothing is pressed', () => {
  const mesh = ballMesh(3, R);
  const surface = new Surface({ ...mesh, accessible: mesh.accessible.map((_, n) => (mesh.positions[3 * n + 2] > 0.02 ? 0 : 1)) });
  assert.equal(Press.begin(surface, down(), TIP, 0), undefined);
});

/** A tool that touches the top, and its answer. */
const top: Vec3 = [0, 0, R];
const tool = { id: 0, state: 1, flags: 1, mine: true, tip: top, proxy: top, anchor: top, force: [0, 0, 1] as Vec3, penetration: 0.001, domainRadius: 0.008 };
const answer = { toolId: 0, flags: 1, tUs: 1, force: 1, penetration: 0.001, wakeupUs: 0, stiffness: 400 };

test('what is felt is painted round the anchor, but not the limits of a device', () => {
  const surface = ball();
  const felt = new FeltMap(surface, 0.01);
  const frame = frameOf(surface.mesh, () => [0, 0, 0]);
  assert.equal(felt.learn({ ...frame, tools: [{ ...tool, flags: 33 }], answers: [answer] }), false);
  assert.equal(felt.learn({ ...frame, tools: [tool], answers: [answer] }), true);
  assert.ok(Math.abs(felt.low - 400) < 1 && Math.abs(felt.high - 400) < 1, `${felt.low} ${felt.high}`);
  const painted = felt.weight.filter((w) => w > 0).length;
  assert.ok(painted > 3 && painted < surface.mesh.nodes / 20, `${painted} nodes`);
});

test('a node keeps what the nearest touch felt there, however long one beside it lasts, and newer touches count', () => {
  const surface = ball();
  const felt = new FeltMap(surface, 0.01);
  const touch = (at: Vec3, stiffness: number): boolean =>
    felt.learn({ ...frameOf(surface.mesh, () => [0, 0, 0]), tools: [{ ...tool, anchor: at }], answers: [{ ...answer, stiffness }] });
  const beside: Vec3 = [0.009, 0, Math.sqrt(R * R - 0.009 ** 2)];
  assert.ok(Number.isNaN(felt.at(top)));
  touch(top, 400);
  for (let i = 0; i < 200; ++i) touch(beside, 300);
  assert.deepEqual([felt.at(top), felt.at(beside), felt.low, felt.high], [400, 300, 300, 400]);
  touch(top, 410);
  assert.deepEqual([felt.at(top), felt.at(beside)], [410, 300]);
  assert.ok(Number.isNaN(felt.at([0, 0, -R])));
});

test('of a press and its release a node keeps what was felt deepest, though the anchor creeps and ends nearer', () => {
  const surface = ball();
  const felt = new FeltMap(surface, 0.01);
  const press = (depth: number, creep: number): boolean =>
    felt.learn({
      ...frameOf(surface.mesh, () => [0, 0, 0]),
      tools: [{ ...tool, anchor: [0.0006 - creep, 0, R] as Vec3 }],
      answers: [{ ...answer, penetration: depth, stiffness: 400 + 1e5 * depth }],
    });
  const depths = [0.0001, 0.001, 0.003, 0.005];
  depths.forEach((depth, i) => press(depth, 1e-4 * i));
  assert.equal(felt.at(top), 900);
  [...depths].reverse().forEach((depth, i) => press(depth, 3e-4 + 1e-4 * i));
  assert.equal(felt.at(top), 900);
  assert.ok(felt.low > 800, `${felt.low}: what the last touch felt is left nowhere`);
  felt.clear();
  press(0.001, 0);
  assert.equal(felt.at(top), 500);
});

test('a touch that is nearer counts though another was deeper', () => {
  const surface = ball();
  const felt = new FeltMap(surface, 0.01);
  const touch = (x: number, depth: number, stiffness: number): boolean =>
    felt.learn({
      ...frameOf(surface.mesh, () => [0, 0, 0]),
      tools: [{ ...tool, anchor: [x, 0, R] as Vec3 }],
      answers: [{ ...answer, penetration: depth, stiffness }],
    });
  touch(0.004, 0.005, 900);
  touch(0, 0.001, 400);
  assert.equal(felt.at(top), 400);
});

test('another tip paints another width, and what the first one felt goes', () => {
  const surface = ball();
  const felt = new FeltMap(surface, 0.01);
  const frame = { ...frameOf(surface.mesh, () => [0, 0, 0]), tools: [tool], answers: [answer] };
  const painted = (): number => felt.weight.filter((w) => w > 0).length;
  felt.learn(frame);
  const narrow = painted();
  felt.setReach(0.02);
  assert.deepEqual([painted(), felt.low, felt.high], [0, Infinity, -Infinity]);
  felt.learn(frame);
  assert.ok(painted() > 2 * narrow, `${painted()} nodes, before ${narrow}`);
});

test('the camera keeps its distance when it turns, and the whole organ is seen at first', () => {
  const orbit = new Orbit();
  orbit.frame([0.1, 0.2, 0.3], 0.2, 0.56, 1.5);
  const away = (): number => norm(sub(orbit.position, orbit.target));
  const distance = away();
  orbit.turn(1, 5);
  assert.ok(Math.abs(away() - distance) < 1e-12 && orbit.elevation <= 1.5);
  orbit.zoom(1e6);
  assert.ok(away() <= 4 * distance + 1e-9);
  orbit.reset();
  assert.ok(Math.abs(away() - distance) < 1e-12);
  near(orbit.target, [0.1, 0.2, 0.3], 1e-12);
});

test('a target that is late goes on at 12 mm/s to its goal, for 100 ms at most', () => {
  const goal: Vec3 = [0, 0, -0.003];
  near(later([0, 0, 0], goal, 50), [0, 0, -0.0006], 1e-12);
  near(later([0, 0, 0], goal, 5000), [0, 0, -0.0012], 1e-12);
  near(later([0, 0, -0.0028], goal, 90), goal, 1e-12);
  near(later(goal, goal, 50), goal, 1e-12);
  near(later([0, 0, 0], goal, -3), [0, 0, 0], 1e-12);
});
