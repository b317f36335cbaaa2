// SPDX-License-Identifier: Apache-2.0
// What is left of a press: no fault, its curve, its figures in a picture and a file, few words for a screen reader.
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { test } from 'node:test';
import { decodePng, shareChanged } from './support/png.mjs';
import { bench, seen, stage } from './support/stage.mjs';

stage({ page: 'once' });

const strip = async () => seen.see(await seen.page.locator('#strip').boundingBox());
/** The strip once two pictures in a row of it are the same. */
async function stillStrip() {
  let before = await strip();
  for (const end = Date.now() + 10_000; Date.now() < end; ) {
    await seen.page.waitForTimeout(300);
    const now = await strip();
    if (shareChanged(before, now) === 0) break;
    before = now;
  }
  return before;
}
/** Whether the strip comes to differ from a picture of it. */
async function stripLeaves(picture) {
  for (const end = Date.now() + 10_000; Date.now() < end; await seen.page.waitForTimeout(50))
    if (shareChanged(picture, await strip()) > 0.002) return true;
  return false;
}
const text = (id) => seen.page.locator(id).textContent();
const saved = async (act) => {
  const [file] = await Promise.all([seen.page.waitForEvent('download'), act()]);
  return readFileSync(await file.path());
};

async function press(depth) {
  await seen.page.locator('#depth').fill(String(depth));
  const place = await seen.middle();
  await seen.page.mouse.move(place.x, place.y);
  await seen.page.mouse.down();
  return seen.until(`pressed ${depth} mm deep`, (f) => f.penetration > 0.00095 * depth && f.force > 0.2);
}

async function release() {
  await seen.page.mouse.up();
  return seen.until('let go', (f) => f.force === 0 && f.tools === 0);
}

/** Counts the texts that come into regions that screen readers read by themselves. */
const listen = () =>
  seen.page.evaluate(() => {
    window.said = [];
    window.listensMs = performance.now();
    const live = [...document.querySelectorAll('[role=status], [role=alert], output, [aria-live]')].filter((e) => e.ariaLive !== 'off');
    for (const region of live)
      new MutationObserver(() => window.said.push(region.textContent)).observe(region, { childList: true, characterData: true, subtree: true });
  });

test('a release is no fault, its curve stays, a screen reader hears a few words, and the slider shows where the model ends', async () => {
  const empty = await stillStrip();
  assert.match(await text('#depth-end'), /A press shows where the model ends/);
  await listen();
  await press(4);
  await seen.page.waitForTimeout(1500); // in which force and penetration change their figures many times
  const end = Number(/about ([\d.]+) mm/.exec(await text('#depth-end'))[1]);
  const pressed = bench.programs[0].log.length; // what is logged until here may tell of a machine that stood still in the press
  await release();
  assert.ok(await stripLeaves(empty), 'the curve is seen');
  const held = await stillStrip();
  await seen.page.waitForTimeout(5000); // a flag of the last tick would have gone; one for as long as nobody holds the tool not
  assert.equal(shareChanged(held, await strip()), 0);

  assert.doesNotMatch(await text('#flags'), /poses stopped|force on its way/); // a busy machine's missed ticks are none of a release
  assert.doesNotMatch(bench.programs[0].log.slice(pressed), /\[warning\].*tool|no good pose/);
  assert.equal(await text('#who'), 'nobody presses');

  // One text in two seconds at the most; those of a form's own regions are not among them here.
  const { said, seconds } = await seen.page.evaluate(() => ({ said: window.said, seconds: (performance.now() - window.listensMs) / 1000 }));
  assert.ok(said.length <= 2 + seconds / 2, `${seconds} s: ${JSON.stringify(said)}`);
  assert.ok(said.some((words) => /^Let go: at most [\d.]+ N, [34]\.\d mm deep$/.test(words)), JSON.stringify(said));

  assert.ok(end > 4 && end < 15, `${end} mm`);
  await seen.page.locator('#depth').fill('15');
  assert.match(await text('#depth-text'), /15\.0 mm, beyond the model/);
  assert.match(await seen.page.locator('#depth').getAttribute('aria-valuetext'), /^15\.0 millimetres; the model ends at about [\d.]+ millimetres here$/);
  const BEYOND = 16;
  const within = Math.floor(0.8 * end);
  await press(within);
  await seen.page.waitForTimeout(700);
  const { flags } = await seen.figures();
  await release();
  assert.equal(flags & BEYOND, 0, `at ${within} mm of ${end}`);
  await press(Math.min(15, Math.ceil(1.25 * end)));
  await seen.until(`beyond ${end} mm`, (f) => (f.flags & BEYOND) !== 0);
  await release();
});

test('a paused curve stays while one presses, and goes on afterwards', async () => {
  await seen.page.locator('#pause').click();
  await seen.page.mouse.move(5, 5);
  assert.equal(await seen.page.locator('#pause').getAttribute('aria-pressed'), 'true');
  const paused = await stillStrip();
  await press(2);
  assert.equal(shareChanged(paused, await strip()), 0);
  await seen.page.locator('#pause').dispatchEvent('click');
  assert.ok(await stripLeaves(paused));
  await release();
});

test('the file of the curves has pose, force vector and parameters', async () => {
  const lines = (await saved(() => seen.page.locator('#csv').click())).toString().trim().split('\n').map((line) => line.split(','));
  const row = (line) => Object.fromEntries(lines[0].map((head, i) => [head, Number(line[i])]));
  const strongest = lines.slice(1).map(row).reduce((a, b) => (b.force_N > a.force_N ? b : a));
  const force = [strongest.force_x_N, strongest.force_y_N, strongest.force_z_N];
  assert.ok(Math.abs(Math.hypot(...force) - strongest.force_N) < 1e-4 * strongest.force_N, JSON.stringify(strongest));
  const tip = [strongest.tip_x_m, strongest.tip_y_m, strongest.tip_z_m];
  const along = force.reduce((sum, f, k) => sum + f * tip[k], 0) / Math.hypot(...force) / Math.hypot(...tip);
  assert.ok(along > 0.8 && Math.hypot(...tip) > 0.035 && Math.hypot(...tip) < 0.056, `the ball pushes outwards: ${JSON.stringify(strongest)}`);
  assert.ok(strongest.youngs_modulus_Pa > 100 && strongest.friction >= 0 && strongest.force_limit_N > 0, JSON.stringify(strongest));
  assert.equal(strongest.tip_radius_m, 0.005);
});

test('a picture has a legend, the scale, force and date below the organ, also while one presses', async () => {
  await seen.page.locator('input[value=displacement]').check({ force: true });
  await press(4);
  await seen.settled();
  const { width, height } = await seen.middle();
  const picture = decodePng(await saved(() => seen.page.locator('#organ').press('p')));
  await release();
  const ratio = picture.width / width;
  assert.ok(picture.height > ratio * (height + 100), `${picture.width} x ${picture.height} of ${width} x ${height}`);
  // The scale's bar: many colours in one row below the organ.
  const most = Math.max(...Array.from({ length: picture.height - Math.ceil(ratio * height) }, (_, i) => {
    const y = Math.ceil(ratio * height) + i;
    return new Set(Array.from({ length: picture.width }, (_, x) => picture.at(x, y).join())).size;
  }));
  assert.ok(most > 60, `${most} colours`);
});
