// SPDX-License-Identifier: Apache-2.0
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { Seen } from './support/browser.mjs';
import { meanOf, shareChanged } from './support/png.mjs';
import { measured, median } from './support/measured.mjs';
import { browser, viewer, stage } from './support/stage.mjs';

stage();

test('the organ is seen after loading', async () => {
  const times = [];
  for (let attempt = 0; attempt < 3; ++attempt) {
    const seen = await Seen.open(browser, viewer.address);
    times.push((await seen.organ()).organSeenMs);
    await seen.close();
  }
  measured('organ seen after loading', median(times), 3000, 'ms');
});

const FLOOR_MS = 20_000; // within which the floor is there, without graphics hardware and beside other tests too

test('it is pixels: the middle is organ, the edge is not, and turning changes the picture', async () => {
  const seen = await Seen.open(browser, viewer.address);
  await seen.organ();
  await seen.shot('light');
  const middle = await seen.middle();
  const organ = meanOf(await seen.around(middle, 20));
  const edge = meanOf(await seen.around({ x: middle.x - 0.45 * middle.width, y: middle.y - 0.3 * middle.height }, 10));
  assert.ok(organ[0] > organ[2] + 8, `porcelain is warm: ${organ}`);
  assert.ok(organ.some((v, k) => Math.abs(v - edge[k]) > 25), `organ ${organ}, edge ${edge}`);
  const canvas = await seen.page.locator('#organ').boundingBox();
  const below = { x: middle.x, y: middle.y + 0.4 * middle.height };
  let floor = edge;
  for (const end = Date.now() + FLOOR_MS; Date.now() < end && !floor.every((v, k) => v < edge[k] - 6); await seen.page.waitForTimeout(250))
    floor = meanOf(await seen.around(below, 10));
  assert.ok(floor.every((v, k) => v < edge[k] - 6), `below the organ: its shadow ${floor}, without one ${edge}`);
  await seen.settled();
  const before = await seen.see(canvas);
  await seen.page.locator('#organ').focus();
  for (let i = 0; i < 4; ++i) await seen.page.keyboard.press('ArrowDown');
  await seen.settled();
  const changed = shareChanged(before, await seen.see(canvas), 6);
  assert.ok(changed > 0.02, `${changed} of the pixels`);
  await seen.close();
});

test('colours follow the choice, and light and dark the system and the button', async () => {
  const seen = await Seen.open(browser, viewer.address, { dark: true });
  await seen.organ();
  await seen.shot('dark');
  const middle = await seen.middle();
  const colours = {};
  for (const choice of ['displacement', 'stiffness', 'plain']) {
    await seen.page.locator(`input[value=${choice}]`).check({ force: true });
    await seen.settled();
    colours[choice] = meanOf(await seen.around(middle, 20));
  }
  const apart = (a, b) => Math.max(...colours[a].map((v, k) => Math.abs(v - colours[b][k])));
  assert.ok(apart('plain', 'displacement') > 40 && apart('plain', 'stiffness') > 40, JSON.stringify(colours));
  assert.ok(apart('displacement', 'stiffness') > 8, JSON.stringify(colours));
  const corner = { x: 30, y: 300 };
  const dark = meanOf(await seen.around(corner, 8));
  await seen.page.locator('#theme').click();
  await seen.settled();
  const light = meanOf(await seen.around(corner, 8));
  assert.ok(light[0] > dark[0] + 120, `dark ${dark}, light ${light}`);
  await seen.close();
});

test('there is no switch for an inside that nothing is known of', async () => {
  const seen = await Seen.open(browser, viewer.address);
  await seen.organ();
  assert.equal(await seen.page.getByText(/inside/i).count(), 0);
  await seen.close();
});
