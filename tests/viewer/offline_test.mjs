// SPDX-License-Identifier: Apache-2.0
// The page that palpate-viewer --export wrote: it needs no address but its own, and after the first time no network.
import assert from 'node:assert/strict';
import { cpSync, readFileSync, utimesSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { aloneStage, browser, DIST, exported, organ, press, scratch, state } from './support/alone.mjs';
import { Seen } from './support/browser.mjs';
import { Bench } from './support/processes.mjs';
import { StaticServer } from './support/static_server.mjs';

aloneStage();
let server, folder, bench;
before(async () => {
  folder = exported('web', organ('liver 1.h5'));
  server = await StaticServer.open([folder]);
  bench = await Bench.open();
});
after(async () => {
  await server?.close();
  await bench?.close();
});

const kept = (seen) => seen.until('works without a network', (f) => f.kept === '');
const cachesOf = (seen) => seen.page.evaluate(() => caches.keys());

test('cut off and loaded again it is pressed; a new model and a new page take the place of the old ones', async () => {
  const seen = await Seen.open(browser, server.address);
  const first = await seen.organ();
  assert.match(await state(seen), /liver 1\.h5, in this page/);
  assert.ok(!server.asked.includes('/login'), 'an exported page asks for no viewer');
  await press(seen);
  await kept(seen);
  await seen.page.locator('dt:text-is("Without a network") + dd:text-is("works")').waitFor();
  const { installabilityErrors } = await (await seen.context.newCDPSession(seen.page)).send('Page.getInstallabilityErrors');
  assert.deepEqual(installabilityErrors.map(({ errorId }) => errorId), ['in-incognito'], 'nothing but the test\'s browser is in the way of installing');

  const cutOff = async () => {
    await server.close();
    await seen.context.setOffline(true);
    await seen.page.reload();
  };
  const [whole, ...others] = await cachesOf(seen);
  assert.deepEqual(others, []);
  await seen.page.evaluate(async () => {
    const half = await caches.open(`palpate ${location.origin}/ 9999`);
    await half.put('./', new Response('half of a copy'));
  });
  await cutOff();
  await seen.organ();
  await press(seen);
  await kept(seen);
  assert.deepEqual(await cachesOf(seen), [whole], 'what was not whole is gone, what was stays');
  const elsewhere = await seen.context.newPage();
  await assert.rejects(elsewhere.goto(`${server.address}other/`), 'other pages of that web server are not palpate');
  await elsewhere.close();

  server = await StaticServer.open([folder], server.port);
  await seen.context.setOffline(false);
  await seen.page.reload();
  await kept(seen);
  assert.deepEqual(await cachesOf(seen), [whole], 'nothing changed, so nothing was copied');
  await cutOff();

  const newer = organ('newer.h5', 2);
  const index = join(folder, 'index.html');
  cpSync(newer, join(folder, 'liver 1.h5'));
  writeFileSync(index, readFileSync(index, 'utf8').replace('<title>palpate<', '<title>newer<'));
  for (const file of [index, join(folder, 'liver 1.h5')]) utimesSync(file, new Date(), new Date(Date.now() + 5000)); // web servers say seconds
  server = await StaticServer.open([folder], server.port);
  await seen.context.setOffline(false);
  await seen.page.reload();
  const second = await seen.organ();
  assert.ok(second.nodes < first.nodes, `${second.nodes} nodes, before ${first.nodes}`);
  await kept(seen);
  await cutOff();
  assert.equal((await seen.organ()).nodes, second.nodes);
  assert.equal(await seen.page.title(), 'newer');
  await press(seen);

  // palpate-viewer at the same address: its own page, always.
  await seen.context.setOffline(false);
  await bench.server(bench.model(1));
  await bench.viewer(server.port);
  await seen.page.reload();
  await seen.until('the organ of the server', (f) => f.nodes > 0 && f.nodes < second.nodes);
  await seen.page.waitForFunction(async () => (await caches.keys()).length === 0 && !(await navigator.serviceWorker.getRegistration()));
  await seen.close();
});

test('started from a home screen, by its address alone, the page opens the model that was named last', async () => {
  organ('named.h5', 2);
  const web = await StaticServer.open([DIST, scratch]);
  const seen = await Seen.open(browser, `${web.address}?model=named.h5`);
  await seen.organ();
  await kept(seen);
  await web.close();
  await seen.context.setOffline(true);
  await seen.page.goto(web.address);
  await seen.organ();
  assert.match(await state(seen), /named\.h5, in this page/);
  await kept(seen);
  await press(seen);
  await seen.close();
});
