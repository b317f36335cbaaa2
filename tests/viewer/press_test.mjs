// SPDX-License-Identifier: Apache-2.0
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { test } from 'node:test';
import { shareChanged } from './support/png.mjs';
import { measured, measuredAtLeast, rounds } from './support/measured.mjs';
import { seen, stage } from './support/stage.mjs';

stage({ server: ['--force-limit', '22'], page: 'each' });

const mouse = () => seen.page.mouse;
const pressAt = async (place) => {
  await mouse().move(place.x, place.y);
  await mouse().down();
};
/** Pressed so deep, and the force has not changed for a while: a page that is drawn slowly sinks in steps. */
const steady = (wanted) => {
  let since = 0, force = 0;
  return seen.until(`pressed ${wanted} mm deep`, (f) => {
    if (Math.abs(f.force - force) > 0.002 * force) [since, force] = [Date.now(), f.force];
    return Math.abs(1000 * f.penetration - wanted) < 0.15 && f.force > 0.2 && Date.now() - since > 800;
  });
};
/** Waits until the picture round a place differs from `before` by a share that `holds`. */
const untilSeen = async (what, before, place, holds) => {
  let share;
  for (const end = Date.now() + 20_000; Date.now() < end; await seen.page.waitForTimeout(300)) {
    share = shareChanged(before, await seen.around(place, 60));
    if (holds(share)) return;
  }
  assert.fail(`${what} is not seen within 20 s: ${share} of the picture changed`);
};
const setSlider = (id, value) =>
  seen.page.locator(id).evaluate((slider, to) => {
    slider.value = to;
    slider.dispatchEvent(new Event('input', { bubbles: true }));
  }, String(value));

test('a drag makes a dent that is seen and a force that is shown, and both go when the finger goes', async () => {
  const place = await seen.middle();
  const before = await seen.around(place, 60);
  await pressAt(place);
  const pressed = await steady(4);
  assert.ok(pressed.largestDisplacement > 0.0015, JSON.stringify(pressed));
  await mouse().move(place.x + 30, place.y + 10, { steps: 8 });
  await seen.settled();
  const shown = Number(await seen.page.locator('#force').textContent());
  assert.ok(shown > 0.2, `shown ${shown} N`);
  assert.ok(Number(await seen.page.locator('#penetration').textContent()) > 2);
  await untilSeen('the dent', before, place, (share) => share > 0.1);
  await seen.shot('pressed');
  await mouse().up();
  await seen.until('at rest again', (f) => f.largestDisplacement < 1e-4 && f.force === 0);
  await untilSeen('the organ without a dent', before, place, (share) => share < 0.02);
});

test('the tool rests on the deformed surface, never inside', async () => {
  const place = await seen.middle();
  await pressAt(place);
  await steady(4);
  const gaps = [];
  for (let i = 0; i < 12; ++i) {
    await mouse().move(place.x + 4 * i, place.y - 3 * i);
    await seen.page.waitForTimeout(60);
    gaps.push((await seen.figures()).gap);
  }
  await mouse().up();
  const seenGaps = gaps.filter((gap) => gap !== null);
  assert.ok(seenGaps.length >= 6 && seenGaps.every((gap) => gap > -1e-5 && gap < 5e-4), `gaps / m: ${gaps}`);
});

test('the wheel and the slider change the depth, and deeper is stronger', async () => {
  const place = await seen.middle();
  await setSlider('#depth', 2);
  await pressAt(place);
  const shallow = await steady(2);
  for (let i = 0; i < 6; ++i) await mouse().wheel(0, -100);
  const deep = await steady(5);
  await setSlider('#depth', 3);
  const between = await steady(3);
  await mouse().up();
  assert.ok(deep.force > 1.3 * between.force && between.force > 1.2 * shallow.force, `${shallow.force} ${between.force} ${deep.force} N`);
});

test('the sliders change the organ: twice as stiff is twice the force, friction is in force', async () => {
  await pressAt(await seen.middle());
  const { force } = await steady(4);
  await setSlider('#stiffness', 1);
  const stiff = await seen.until('twice the force', (f) => Math.abs(f.force / force - 2) < 0.1 && Math.abs(f.inForce.youngsFactor - 2) < 0.01);
  assert.ok(stiff.force > 1.9 * force);
  await setSlider('#friction', 1.2);
  await seen.until('friction 1.2', (f) => Math.abs(f.inForce.friction - 1.2) < 1e-6);
  await setSlider('#stiffness', 0);
  await seen.until('the force of before', (f) => Math.abs(f.force / force - 1) < 0.1);
  await mouse().up();
});

/** A drag of 10 s, and what the page saved of it. */
async function savedDrag() {
  const place = await seen.middle();
  await pressAt(place);
  await steady(4);
  const end = Date.now() + 10_500;
  for (let i = 0; Date.now() < end; ++i) {
    await mouse().move(place.x + 70 * Math.sin(0.05 * i), place.y + 30 * Math.sin(0.031 * i));
    await seen.page.waitForTimeout(15);
  }
  const [file] = await Promise.all([seen.page.waitForEvent('download'), seen.page.locator('#csv').dispatchEvent('click')]);
  await mouse().up();
  const [head, ...all] = readFileSync(await file.path(), 'utf8').trim().split('\n');
  assert.match(head, /^t_s,tool_id,force_N,penetration_m,flags,force_x_N,/);
  // A page that stood still for a while lets go, and may press again by another tool: the one that pressed longest.
  const toolOf = (line) => line.split(',')[1];
  const ofTools = [...new Set(all.map(toolOf))].map((tool) => all.filter((line) => toolOf(line) === tool));
  const lines = ofTools.reduce((most, some) => (some.length > most.length ? some : most), []);
  const columns = (k) => lines.map((line) => Number(line.split(',')[k]));
  return { times: columns(0), forces: columns(2), flags: columns(4) };
}

test('a drag of 10 s gives a force curve without gaps, as saved', async () => {
  const TICK_OVERRUN = 65536;
  for (let attempt = 0; attempt < rounds(1, 3); ++attempt) {
    const { times, forces, flags } = await savedDrag();
    const steps = times.slice(1).map((t, i) => t - times[i]);
    assert.ok(times.length > 100 && steps.every((step) => step > 0), `${times.length} samples`);
    assert.ok(forces.every((f) => f >= 0 && f <= 22.001) && Math.max(...forces) > 0.1, `${Math.max(...forces)} N`);
    // The machine may stop the whole server: then its own next answer says that it missed ticks.
    const others = steps.filter((_, i) => !(flags[i + 1] & TICK_OVERRUN));
    console.log(`${times.length} samples, ${steps.length - others.length} after ticks that the server missed, ` +
      `largest gap of all ${(1000 * Math.max(...steps)).toFixed(1)} ms`);
    measured('largest gap in the force curve of a drag', 1000 * Math.max(...others), 50, 'ms');
    measuredAtLeast('length of the force curve of a drag', times.at(-1) - times[0], 9.5, 's');
    measuredAtLeast('least force in a drag', Math.min(...forces), 0.1, 'N'); // a page that stood still for 0.25 s lets go
    await seen.until('at rest', (f) => f.force === 0);
  }
});

test('what was felt is painted where it was felt', async () => {
  await seen.page.locator('input[value=stiffness]').check({ force: true });
  await seen.settled();
  const place = await seen.middle();
  const before = await seen.around(place, 30);
  await pressAt(place);
  await steady(4);
  await mouse().move(place.x + 60, place.y, { steps: 10 });
  await seen.settled();
  await mouse().up();
  const { felt } = await seen.until('at rest', (f) => f.largestDisplacement < 1e-4);
  assert.ok(felt.low > 50 && felt.high >= felt.low, JSON.stringify(felt));
  await seen.settled();
  assert.ok(shareChanged(before, await seen.around(place, 30)) > 0.3);
  await seen.shot('felt');
});

test('a picture is saved as PNG', async () => {
  const [file] = await Promise.all([seen.page.waitForEvent('download'), seen.page.locator('#picture').click()]);
  assert.match(file.suggestedFilename(), /^palpate-\d{8}-\d{6}\.png$/);
  const png = readFileSync(await file.path());
  assert.equal(png.toString('latin1', 1, 4), 'PNG');
  assert.ok(png.length > 10_000, `${png.length} bytes`);
});
