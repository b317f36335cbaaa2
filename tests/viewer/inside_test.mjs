// SPDX-License-Identifier: Apache-2.0
// An organ of 160 kPa whose top is a cone of 1600 kPa, and whose bottom is clamped.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { meanOf } from './support/png.mjs';
import { bench, seen, stage } from './support/stage.mjs';

stage({ model: () => bench.model(4, 0.7), page: 'each' });

const middle = async () => meanOf(await seen.around(await seen.middle(), 20));
const look = async (key, times) => {
  await seen.page.locator('#organ').focus();
  for (let i = 0; i < times; ++i) await seen.page.keyboard.press(key);
  await seen.settled();
};
const lines = () => seen.page.locator('#parts p').allTextContents();
const inside = () => seen.page.getByLabel(/^Show inside/);

test('the inside shows through the organ, in its own colour, while the box is checked', async () => {
  await look('ArrowDown', 40); // from above
  const outside = await middle();
  await inside().check();
  await seen.settled();
  const [red, , blue] = await middle();
  assert.ok(red - blue > outside[0] - outside[2] + 40, `vermilion, not ${[red, blue]}; before ${outside}`);
  await seen.shot('inside');
  await inside().uncheck();
  await seen.settled();
  const again = await middle();
  assert.ok(again.every((v, k) => Math.abs(v - outside[k]) < 3), `${again}, before ${outside}`);
});

test('names and stiffness stand in the legend, follow the live one, and it is said that the inside does not move', async () => {
  assert.deepEqual(await lines(), ['clamped', 'elsewhere 160 kPa', 'nodule 1600 kPa']);
  assert.equal(await seen.page.getByText('(drawn at rest)').count(), 1);
  await seen.page.locator('#stiffness').fill('1');
  await seen.until('twice as stiff', (f) => f.inForce.youngsFactor === 2);
  assert.deepEqual(await lines(), ['clamped', 'elsewhere 320 kPa', 'nodule 3200 kPa']);
  await seen.page.locator('#stiffness').fill('0');
  await seen.until('as before', (f) => f.inForce.youngsFactor === 1);
});

test('what is clamped is dark and grey in all colours of the rest, and in the legend', async () => {
  await look('ArrowUp', 40); // from below
  for (const choice of ['displacement', 'stiffness', 'plain']) {
    await seen.page.locator(`input[value=${choice}]`).check({ force: true });
    await seen.settled();
    const clamped = await middle();
    assert.ok(Math.max(...clamped) < 130 && Math.max(...clamped) - Math.min(...clamped) < 20, `${choice}: ${clamped}`);
  }
  await seen.shot('clamped');
});
