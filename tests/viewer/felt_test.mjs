// SPDX-License-Identifier: Apache-2.0
// The map of the stiffness felt, drawn by palpate-tool as tools/demo lets it press: a stiff place, then a softer one 8 mm
// beside. The tests' round organ is 1 + 0.3 sin(3 x + 2 y + z) times as stiff as its mean, (x, y, z) the unit normal.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { bin } from './support/processes.mjs';
import { bench, seen, stage } from './support/stage.mjs';

stage({ page: 'once' });

const RADIUS = 0.05;
const factor = ([x, y, z]) => 1 + 0.3 * Math.sin(3 * x + 2 * y + z);
/** On the great circle from the direction of (3, 2, 1) to that of (-1, 0, 3), in degrees. */
const normalAt = (degrees) => {
  const angle = (degrees * Math.PI) / 180;
  return [3, 2, 1].map((c, k) => (Math.cos(angle) * c) / Math.sqrt(14) + (Math.sin(angle) * [-1, 0, 3][k]) / Math.sqrt(10));
};
const [stiff, soft] = [normalAt(74.5), normalAt(83.7)]; // 8 mm apart
const pointOf = (normal) => normal.map((c) => RADIUS * c);
const felt = (normal) => seen.page.evaluate((point) => window.palpate.felt(point), pointOf(normal));

test('the page says what the certificate of the served model states', async () => {
  const line = seen.page.locator('#certificate');
  assert.equal(await line.textContent(), 'not certified: the model file does not state how far its answers are off');
});

test('after a press by palpate-tool and one beside it, the map is stiffer where the organ is', async () => {
  assert.ok(Number.isNaN(await felt(stiff)));
  const args = ['--script', 'press', '--depth', '0.002', '--tool', '0', `--at=${pointOf(stiff)}`, `--beside=${pointOf(soft)}`];
  const tool = bench.start(bin('palpate-tool'), args);
  assert.equal(await tool.ended, 0, tool.log);
  await seen.until('the tool has left', (f) => f.tools === 0);
  const [there, beside] = [await felt(stiff), await felt(soft)];
  const ratio = there / beside, real = factor(stiff) / factor(soft);
  assert.ok(Math.abs(ratio - real) < 0.05, `${there} and ${beside} N/m: ratio ${ratio}, the organ's ${real}`);
  const { low, high } = (await seen.figures()).felt;
  assert.ok(low <= beside && high >= there, `scale ${low} to ${high}`);
  await seen.page.locator('input[value=stiffness]').check({ force: true });
  await seen.shot('felt');
});

test('of another E nothing was felt yet', async () => {
  await seen.page.locator('#stiffness').fill('-1');
  await seen.until('half as stiff', (f) => f.inForce.youngsFactor === 0.5);
  assert.ok(Number.isNaN(await felt(stiff)));
});
