// SPDX-License-Identifier: Apache-2.0
// The page without a server: a model file from a plain web server, core as WebAssembly in the page's worker.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { createReadStream, existsSync, mkdtempSync, rmSync, statSync } from 'node:fs';
import { createServer } from 'node:http';
import { tmpdir } from 'node:os';
import { extname, join } from 'node:path';
import { after, before, test } from 'node:test';
import { fileURLToPath } from 'node:url';
import { openBrowser, Seen, skipWithoutBrowser } from './support/browser.mjs';

const WASM = process.env.PALPATE_WASM;
const DIST = fileURLToPath(new URL('../../clients/viewer/web/dist', import.meta.url));
const TYPES = { '.html': 'text/html', '.mjs': 'text/javascript', '.js': 'text/javascript', '.css': 'text/css', '.wasm': 'application/wasm', '.svg': 'image/svg+xml' };

skipWithoutBrowser();
if (!existsSync(join(WASM ?? '', 'palpate_core.wasm'))) {
  console.log('SKIPPED: core is not built as WebAssembly');
  process.exit(0);
}

let scratch, server, address, browser;

/** Any web server: files, nothing else. */
function serve(request, response) {
  const path = new URL(request.url, 'http://x').pathname;
  const file = path.startsWith('/core/') ? join(WASM, path.slice(6)) : path.endsWith('.h5') ? join(scratch, path) : join(DIST, path);
  if (!existsSync(file)) return response.writeHead(404).end();
  response.writeHead(200, { 'content-type': TYPES[extname(file)] ?? 'application/octet-stream', 'content-length': statSync(file).size });
  createReadStream(file).pipe(response);
}

before(async () => {
  scratch = mkdtempSync(join(tmpdir(), 'palpate-alone-'));
  execFileSync(join(process.env.PALPATE_TEST_BIN, 'write_round_organ'), [join(scratch, 'organ.h5'), '3', '0.3']);
  server = createServer(serve);
  await new Promise((done) => server.listen(0, '127.0.0.1', done));
  address = `http://127.0.0.1:${server.address().port}/index.html`;
  browser = await openBrowser();
});
after(async () => {
  await browser?.close();
  server?.close();
  rmSync(scratch, { recursive: true, force: true });
});

const state = (seen) => seen.page.locator('#state-text').textContent();

test('a press is answered in the page itself, and the organ comes to rest when the hand goes', async () => {
  const seen = await Seen.open(browser, `${address}?model=organ.h5`);
  await seen.organ();
  assert.match(await state(seen), /organ\.h5, in this page/);
  const place = await seen.middle();
  await seen.page.mouse.move(place.x, place.y);
  await seen.page.mouse.down();
  const pressed = await seen.until('pressed 4 mm deep', (f) => f.penetration > 0.0038 && f.penetration < 0.0045 && f.force > 0.2);
  assert.ok(pressed.largestDisplacement > 0.0015, JSON.stringify(pressed));
  assert.equal(pressed.toolId, 0);
  await seen.page.mouse.up();
  const rest = await seen.until('at rest again', (f) => f.largestDisplacement < 1e-4 && f.force === 0 && f.toolId === null);
  assert.ok(rest.felt.high > 0, 'the map of stiffness has what was felt');
  await seen.close();
});

test('a tool that is taken back while it lifts off goes on, and its end is not told', async () => {
  const seen = await Seen.open(browser, `${address}?model=organ.h5`);
  await seen.organ();
  const place = await seen.middle();
  await seen.page.mouse.move(place.x, place.y);
  await seen.page.mouse.down();
  await seen.until('pressed', (f) => f.force > 0.2);
  await seen.page.mouse.up();
  await seen.page.waitForTimeout(30);
  await seen.page.mouse.down();
  await seen.until('off, or on its way back', (f) => f.force < 0.2);
  await seen.until('pressed again', (f) => f.penetration > 0.0038 && f.force > 0.2 && f.toolId === 0);
  await seen.page.waitForTimeout(500); // longer than lifting off takes
  assert.equal((await seen.figures()).toolId, 0);
  await seen.close();
});

test('a softer organ is asked for, and is in force', async () => {
  const seen = await Seen.open(browser, `${address}?model=organ.h5`);
  await seen.organ();
  await seen.page.locator('#stiffness').evaluate((slider) => {
    slider.value = '-1';
    slider.dispatchEvent(new Event('input', { bubbles: true }));
  });
  await seen.until('half as stiff', (f) => Math.abs(f.inForce.youngsFactor - 0.5) < 1e-6);
  await seen.close();
});

test('what is no model is said in words', async () => {
  const seen = await Seen.open(browser, `${address}?model=none.h5`);
  await seen.page.waitForFunction(() => /404/.test(document.querySelector('#state-text').textContent), undefined, { timeout: 15_000 });
  assert.match(await state(seen), /none\.h5: the web server answers 404/);
  await seen.close();
});
