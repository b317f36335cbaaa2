// SPDX-License-Identifier: Apache-2.0
// A phone, a keyboard, and several people at once.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { Seen } from './support/browser.mjs';
import { browser, viewer, stage } from './support/stage.mjs';

stage();

/** Fingers on the screen, as the browser's own input. */
const touches = async (seen) => {
  const device = await seen.context.newCDPSession(seen.page);
  return (type, points) => device.send('Input.dispatchTouchEvent', { type, touchPoints: points.map((p, id) => ({ ...p, id })) });
};

test('on a phone all fits, a finger presses, two fingers turn it into zooming', async () => {
  const seen = await Seen.open(browser, viewer.address, { phone: true });
  await seen.organ();
  const wide = await seen.page.evaluate(() => document.documentElement.scrollWidth - innerWidth);
  assert.ok(wide <= 0, `the page is ${wide} px too wide`);
  for (const id of ['#organ', '#force', '#strip', '#theme', '#picture']) assert.ok(await seen.page.locator(id).isVisible(), id);
  const middle = await seen.middle();
  const touch = await touches(seen);
  await touch('touchStart', [{ x: middle.x, y: middle.y }]);
  await seen.until('a force', (f) => f.pressing && f.force > 0.2 && f.penetration > 0.002);
  await touch('touchMove', [{ x: middle.x + 15, y: middle.y + 8 }]);
  await seen.shot('phone');
  await touch('touchStart', [{ x: middle.x + 15, y: middle.y + 8 }, { x: middle.x - 60, y: middle.y }]);
  await seen.until('let go', (f) => !f.pressing);
  const rule = () => seen.page.locator('#rule-bar').evaluate((bar) => bar.style.width + bar.parentElement.textContent);
  const before = await rule();
  await touch('touchMove', [{ x: middle.x + 80, y: middle.y + 8 }, { x: middle.x - 120, y: middle.y }]);
  await touch('touchEnd', []);
  await seen.settled();
  assert.notEqual(await rule(), before);
  await seen.close();
});

test('the keyboard presses, slides, goes deeper, and reaches every control', async () => {
  const seen = await Seen.open(browser, viewer.address);
  await seen.organ();
  const keys = seen.page.keyboard;
  await seen.page.locator('#organ').focus();
  await keys.down('Enter');
  const pressed = await seen.until('a force', (f) => f.pressing && f.penetration > 0.0038);
  for (let i = 0; i < 3; ++i) await keys.press('PageDown');
  const deeper = await seen.until('deeper', (f) => f.penetration > 0.0053);
  assert.ok(deeper.force > pressed.force);
  await keys.up('Enter');
  await seen.until('at rest', (f) => !f.pressing && f.force === 0);
  const reached = new Set();
  for (let i = 0; i < 16; ++i) {
    await keys.press('Tab');
    reached.add(await seen.page.evaluate(() => document.activeElement?.id || document.activeElement?.getAttribute('name') || document.activeElement?.tagName));
  }
  for (const id of ['home', 'picture', 'theme', 'organ', 'csv', 'depth', 'stiffness', 'friction', 'colouring'])
    assert.ok(reached.has(id), `${id} is not among ${[...reached]}`);
  const nameless = await seen.page.evaluate(() =>
    [...document.querySelectorAll('input, button')].filter((e) => !(e.labels?.length || e.textContent.trim() || e.ariaLabel)).length);
  assert.equal(nameless, 0);
  await seen.close();
});

test('three pages at once: each has its own tool, and all see all of them', async () => {
  const pages = [];
  for (let i = 0; i < 3; ++i) pages.push(await Seen.open(browser, viewer.address, { width: 700, height: 500 }));
  for (const seen of pages) await seen.organ();
  const offsets = [-60, 0, 60];
  for (const [i, seen] of pages.entries()) {
    const middle = await seen.middle();
    await seen.page.bringToFront();
    await seen.page.mouse.move(middle.x + offsets[i], middle.y);
    await seen.page.mouse.down();
    await seen.until('a tool of its own', (f) => f.toolId !== null);
  }
  // A page that stood still has let go, and asks for a tool again: all are looked at together, until all press.
  let figures;
  const all = (f) => f.every((one) => one.tools === 3 && one.force > 0.1) && new Set(f.map((one) => one.toolId)).size === 3;
  for (const end = Date.now() + 20_000; Date.now() < end; await pages[0].page.waitForTimeout(50)) {
    figures = await Promise.all(pages.map((seen) => seen.figures()));
    if (all(figures)) break;
  }
  assert.ok(all(figures), `tools ${figures.map((one) => `${one.toolId} of ${one.tools}`)}`);
  for (const seen of pages) await seen.page.mouse.up();
  for (const seen of pages) await seen.until('at rest', (f) => f.force === 0);
  for (const seen of pages) await seen.close();
});
