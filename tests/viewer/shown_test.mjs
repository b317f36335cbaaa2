// SPDX-License-Identifier: Apache-2.0
// The page at 320, 390 and 1280 px, light and dark, before there is a server, with one, and after it went. axe-core judges the two ends,
// 320 px light and 1280 px; what a finger is to hit is measured where the page is narrow.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { seriousIn } from './support/axe.mjs';
import { Seen } from './support/browser.mjs';
import { assertApart, atEverySize, laidOut, tooSmall } from './support/layout.mjs';
import { meanOf } from './support/png.mjs';
import { bench, browser, stage } from './support/stage.mjs';

stage({ serve: false });

const APART = [['#hint', '.tools'], ['.legend', '.rule'], ['.tools', '.legend'], ['#notice', '.tools'], ['#absent', '.tools']];

/** Takes a picture at each size, light and dark, and checks what must fit there. @param there  of APART, what is seen now */
async function fits(seen, name, there) {
  await atEverySize(seen, async (width, dark) => {
    await seen.shot(`${name}-${width}-${dark ? 'dark' : 'light'}`, 250);
    await laidOut(seen.page, async () => {
      assert.ok((await seen.page.evaluate(() => document.documentElement.scrollWidth - innerWidth)) <= 0, `${width} px: the page is too wide`);
      await assertApart(seen.page, APART, there);
      if (width < 820) assert.deepEqual(await tooSmall(seen.page), [], `${width} px`);
    });
    if (width === 1280 || (width === 320 && !dark)) assert.deepEqual(await seriousIn(seen.page), [], `${width} px, ${dark ? 'dark' : 'light'}`);
  });
}

const text = (seen, id) => seen.page.locator(id).textContent();
const colour = async (seen) => meanOf(await seen.around(await seen.middle(), 12));
const spread = (c) => Math.max(...c) - Math.min(...c);

test('at every size, without, with and after a server, all fits, can be hit and read, and it is said who answers', async () => {
  const viewer = await bench.viewer();
  const seen = await Seen.open(browser, viewer.address);

  // 1. No server yet.
  await seen.page.locator('#absent').waitFor();
  assert.equal(await text(seen, '#absent-title'), 'No server yet');
  assert.match(await text(seen, '#absent-help'), /palpate-server --model/);
  await fits(seen, 'waiting', ['#absent']);
  const place = await seen.middle();
  await seen.page.mouse.click(place.x, place.y - 150);
  assert.match(await text(seen, '#notice'), /Nothing answers a press: waiting for a server/);

  // 2. One comes.
  const server = await bench.server(bench.model(4, 0.7));
  await seen.until('the organ', (f) => f.nodes === 2562 && f.state.level === 'good');
  assert.ok(await seen.page.locator('#absent').isHidden());
  await seen.page.locator('#notice').waitFor({ state: 'hidden' });
  await fits(seen, 'served', ['#hint', '.legend', '.rule', '.tools']);
  const tissue = await colour(seen);
  assert.ok(tissue[0] > tissue[2] + 40, `an organ is red, not ${tissue}`);

  // 3. It goes.
  await server.stop('SIGKILL');
  await seen.until('gone', (f) => f.state.level === 'bad');
  await seen.settled();
  assert.equal(await text(seen, '#absent-title'), 'The server is gone');
  const size = await seen.page.locator('#absent-title').evaluate((e) => parseFloat(getComputedStyle(e).fontSize));
  assert.ok(size >= 20, `${size} px is not large`);
  await seen.page.locator('#absent').evaluate((card) => (card.style.opacity = 0)); // what is behind it
  const grey = await colour(seen);
  assert.ok(spread(grey) < 30 && spread(grey) < 0.3 * spread(tissue), `grey ${grey}, tissue ${tissue}`);
  await seen.page.locator('#absent').evaluate((card) => card.removeAttribute('style'));
  await fits(seen, 'gone', ['#absent']);
  const { x, y } = await seen.middle();
  await seen.page.mouse.move(x, y);
  await seen.page.mouse.down();
  assert.match(await text(seen, '#notice'), /Nothing answers a press: no word from the server/);
  assert.ok(!(await seen.figures()).pressing);
  await seen.page.mouse.up();
  await seen.close();
});
