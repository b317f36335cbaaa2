// SPDX-License-Identifier: Apache-2.0
// An organ of 160 kPa whose top is a cone of 1600 kPa, and whose bottom is clamped.
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { test } from 'node:test';
import { decodePng, meanOf } from './support/png.mjs';
import { bench, seen, stage } from './support/stage.mjs';

stage({ model: () => bench.model(4, 0.7), page: 'each' });

const middle = async () => meanOf(await seen.around(await seen.middle(), 20));
const look = async (key, times) => {
  await seen.page.locator('#organ').focus();
  for (let i = 0; i < times; ++i) await seen.page.keyboard.press(key);
  await seen.settled();
};
const colourBy = (choice) => seen.page.locator(`input[value=${choice}]`).check({ force: true });
const lines = () => seen.page.locator('#parts p').allTextContents();
const inside = () => seen.page.getByLabel(/^Show inside/);

test('the inside shows through the organ, in its own colour, while the box is checked', async () => {
  await colourBy('displacement');
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
  assert.deepEqual(await lines(), ['clamped', 'cannot be touched', 'elsewhere 160 kPa', 'nodule 1600 kPa']);
  assert.equal(await seen.page.getByText('(drawn at rest)').count(), 1);
  await seen.page.locator('#stiffness').fill('1');
  await seen.until('twice as stiff', (f) => f.inForce.youngsFactor === 2);
  assert.deepEqual(await lines(), ['clamped', 'cannot be touched', 'elsewhere 320 kPa', 'nodule 3200 kPa']);
  await seen.page.locator('#stiffness').fill('0');
  await seen.until('as before', (f) => f.inForce.youngsFactor === 1);
});

/** From below, a place on the ring round the clamp (z / R from -0.7 to -0.55) that no tool may touch, CSS pixels. */
async function onTheRing() {
  const [pixels, metres] = await seen.page.locator('#rule-bar').evaluate((bar) => {
    const [, value, unit] = /([\d.]+) (mm|cm)/.exec(bar.parentElement.textContent);
    return [parseFloat(bar.style.width), Number(value) * (unit === 'cm' ? 0.01 : 0.001)];
  });
  const [R, distance] = [0.05, (0.41 * 2 * 0.05 * Math.sqrt(3)) / Math.sin((16 * Math.PI) / 180)]; // of the camera from the middle
  const z = 0.63 * R, across = Math.sqrt(R * R - z * z) * (distance / (distance - z));
  const { x, y } = await seen.middle();
  return { x: x + (across * pixels) / metres, y };
}

test('what is clamped is dark and grey, what cannot be touched has a violet of its own, in all colours of the rest', async () => {
  await look('ArrowUp', 40); // from below
  for (const choice of ['displacement', 'stiffness', 'plain']) {
    await colourBy(choice);
    await seen.settled();
    const clamped = await middle();
    assert.ok(Math.max(...clamped) < 130 && Math.max(...clamped) - Math.min(...clamped) < 20, `${choice}: ${clamped}`);
    const [red, green, blue] = meanOf(await seen.around(await onTheRing(), 3));
    assert.ok(blue > red && red > green + 5 && blue > green + 15, `${choice}: ${[red, green, blue]} is not violet`);
  }
  await seen.shot('clamped');
  const { x, y } = await onTheRing();
  await seen.page.mouse.click(x, y);
  assert.match(await seen.page.locator('#notice').textContent(), /No tool may touch here/);
});

test('a picture of a narrow page has the whole legend, in as many rows as it takes', async () => {
  const caption = async (width) => {
    await seen.page.setViewportSize({ width, height: 700 });
    await seen.settled();
    const { height } = await seen.middle();
    const [file] = await Promise.all([seen.page.waitForEvent('download'), seen.page.locator('#organ').press('p')]);
    const picture = decodePng(readFileSync(await file.path()));
    const ratio = picture.width / (await seen.middle()).width;
    return { picture, ratio, top: Math.ceil(ratio * height), height: picture.height / ratio - height };
  };
  await inside().check(); // then the tissues are in it
  const [wide, narrow] = [await caption(1280), await caption(320)];
  assert.ok(narrow.height > wide.height + 15, `${narrow.height} px below the organ, on a wide page ${wide.height}`);
  const { picture, ratio, top } = narrow;
  for (let y = top + 2; y < picture.height; ++y)
    for (let x = Math.ceil(picture.width - 10 * ratio); x < picture.width; ++x)
      assert.deepEqual(picture.at(x, y), picture.at(picture.width - 1, picture.height - 1), `something is cut off at ${x}, ${y}`);
});

test('a nodule is found by palpating, with a score, and is not looked at meanwhile', async () => {
  await look('ArrowDown', 40); // from above, where it is
  await inside().check();
  await seen.page.locator('#training summary').click();
  await seen.page.locator('#goal').selectOption('nodule');
  await seen.page.locator('#goal-limit').fill('10');
  await seen.page.locator('#goal-start').click();
  assert.ok(await inside().isDisabled());
  await seen.page.locator('#goal-here').click();
  assert.match(await seen.page.locator('#goal-words').textContent(), /Press on the organ first/);
  const place = await seen.middle();
  await seen.page.mouse.move(place.x, place.y);
  await seen.page.mouse.down();
  await seen.until('pressed', (f) => f.penetration > 0.002 && f.force > 2);
  await seen.page.locator('#goal-words', { hasText: /at most ([2-9]|\d\d)\.\d N/ }).waitFor(); // a force that counts
  await seen.page.mouse.up();
  await seen.page.locator('#goal-here').click();
  const words = seen.page.locator('#goal-words', { hasText: 'of 100 points' });
  const [, points, off] = /^(\d+) of 100 points: (\d+) mm off/.exec(await words.textContent());
  assert.ok(Number(points) >= 70 && Number(off) <= 5, `${points} points, ${off} mm off`);
  assert.ok(await inside().isEnabled());

  await seen.page.locator('#goal-start').click();
  assert.ok(await inside().isDisabled());
  await bench.programs[0].stop('SIGKILL');
  await seen.page.locator('#goal-words', { hasText: 'The server is gone' }).waitFor();
  assert.ok(await inside().isEnabled(), 'a goal ends with the server');
});
