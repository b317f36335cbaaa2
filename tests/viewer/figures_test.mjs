// SPDX-License-Identifier: Apache-2.0
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { measured, median } from './support/measured.mjs';
import { bench, seen, stage } from './support/stage.mjs';

stage({ model: () => process.env.PALPATE_TEST_MODEL ?? bench.model(), page: 'once' });

test('the panel prints pictures a second, bytes a frame and the way from DDS to the page', async () => {
  const middle = await seen.middle();
  await seen.page.mouse.move(middle.x, middle.y);
  await seen.page.mouse.down();
  const [printed, medians] = [[], []]; // once a second
  for (let i = 0, end = Date.now() + 15_000; Date.now() < end; ++i) {
    await seen.page.mouse.move(middle.x + 60 * Math.sin(0.07 * i), middle.y + 25 * Math.sin(0.05 * i));
    await seen.page.waitForTimeout(20);
    if (Date.now() < end - 15_000 + 1000 * (printed.length + 2)) continue;
    printed.push(await seen.panel());
    medians.push((await seen.figures()).decodedMs.p50);
  }
  const figures = await seen.figures();
  await seen.page.mouse.up();
  const last = printed.at(-1);
  console.log(Object.entries(last).map(([name, value]) => `  ${name}: ${value}`).join('\n'));
  console.log(`  nodes: ${figures.nodes}`);
  assert.match(last['Pictures drawn'], /^[1-9]\d* \/ s/);
  const kilobytes = Number(/([\d.]+) kB/.exec(last['Frames received'])[1]);
  assert.ok(kilobytes > 1 && kilobytes < 60, last['Frames received']);
  assert.ok(medians.length > 0 && medians.every((ms) => ms > 0), `medians / ms: ${medians}`);
  assert.match(last['DDS to decoded'], /^\d+(\.\d)? \/ \d+(\.\d)? ms$/);
  measured('DDS sample to decoded frame, p50', median(medians), 10, 'ms');
  assert.match(last['Tick'], /^\d+(\.\d)? \/ \d+(\.\d)? µs$/);
});

test('times of the last minute and second stand below those of the run, and no value is cut', async () => {
  const names = Object.keys(await seen.panel());
  for (const name of ['Tick', 'Woke late'])
    assert.deepEqual(names.slice(names.indexOf(name), names.indexOf(name) + 3), [name, `${name}, last minute`, `${name}, last second`]);
  await seen.page.setViewportSize({ width: 320, height: 700 });
  const cut = await seen.page.evaluate(() => {
    const value = [...document.querySelectorAll('#health-list dd')];
    value.at(-1).textContent = '1234: another thread 1000, page faults 234'; // the longest, until it is written again
    return value.filter((dd) => dd.scrollWidth > dd.clientWidth).map((dd) => dd.textContent);
  });
  await seen.page.setViewportSize({ width: 1000, height: 700 });
  assert.deepEqual(cut, []);
});

test('at rest it draws nothing', async () => {
  await seen.page.mouse.move(5, 5);
  await seen.page.waitForTimeout(3000);
  const before = (await seen.figures()).pictures;
  await seen.page.waitForTimeout(2000);
  assert.ok((await seen.figures()).pictures <= before + 1);
});

test('flags are said in words', async () => {
  const middle = await seen.middle();
  await seen.page.locator('#depth').evaluate((slider) => {
    slider.value = '14';
    slider.dispatchEvent(new Event('input', { bubbles: true }));
  });
  await seen.page.mouse.move(middle.x, middle.y);
  await seen.page.mouse.down();
  await seen.until('beyond the domain, or at the limit', (f) => (f.flags & (16 | 32)) !== 0);
  await seen.settled();
  const words = await seen.page.locator('#flags').textContent();
  await seen.page.mouse.up();
  assert.match(words, /deeper than the model was computed for|force held at its limit/);
  await seen.until('at rest', (f) => f.force === 0);
  const gone = () => !/deeper than the model was computed for|force held at its limit/.test(document.querySelector('#flags').textContent);
  await seen.page.waitForFunction(gone, undefined, { timeout: 20_000 }); // held for a few seconds, not for ever
});
