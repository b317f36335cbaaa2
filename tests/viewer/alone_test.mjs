// SPDX-License-Identifier: Apache-2.0
// The page without a server: a model file from a plain web server, core as WebAssembly in the page's worker.
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { aloneStage, browser, DIST, drop, organ, press, scratch, state } from './support/alone.mjs';
import { Seen } from './support/browser.mjs';
import { meanOf } from './support/png.mjs';
import { StaticServer } from './support/static_server.mjs';

aloneStage();
let server, address;
before(async () => {
  organ('organ.h5');
  organ('coarser.h5', 2);
  server = await StaticServer.open([DIST, scratch]);
  address = `${server.address}index.html`;
});
after(() => server?.close());

test('a press is answered in the page itself, and the organ comes to rest when the hand goes', async () => {
  const seen = await Seen.open(browser, `${address}?model=organ.h5`);
  await seen.organ();
  assert.match(await state(seen), /organ\.h5, in this page/);
  assert.equal(await seen.page.locator('#certificate').textContent(), 'not certified: the model file does not state how far its answers are off');
  const pressed = await press(seen);
  assert.ok(pressed.penetration < 0.0045, `${pressed.penetration} m`);
  assert.ok(pressed.largestDisplacement > 0.0015, JSON.stringify(pressed));
  assert.equal(pressed.toolId, 0);
  assert.ok(pressed.samples > 100, `${pressed.samples} samples for the strip chart`);
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

test('an address that is none, or no text, is said; a name that is none is its address', async () => {
  const seen = await Seen.open(browser, `${address}?model=http://[`);
  await seen.page.locator('#offer').waitFor();
  assert.match(await state(seen), /\?model=http:\/\/\[ is no address/);
  server.first['/a/b.h5'] = [[200, readFileSync(join(scratch, 'coarser.h5'))]];
  await seen.page.goto(`${address}?model=a%252Fb.h5`);
  await seen.organ();
  assert.match(await state(seen), /a\/b\.h5, in this page/);
  server.first['/%E0%A4%A.h5'] = [[200, readFileSync(join(scratch, 'coarser.h5'))]];
  await seen.page.goto(`${address}?model=${encodeURIComponent('%E0%A4%A.h5')}`);
  await seen.organ();
  assert.match(await state(seen), /%E0%A4%A\.h5, in this page/);
  await seen.page.goto(`${address}?model=models/`);
  await seen.page.getByText('models/: the web server answers 404').first().waitFor();
  await seen.close();
});

test('a palpate-viewer that is not back yet is waited for: its page is not alone', async () => {
  server.first['/login'] = [[503, ''], [502, 'null'], [200, '{"needed":false}']];
  const seen = await Seen.open(browser, `${address}?model=organ.h5`);
  await seen.page.getByText('A palpate-viewer serves this page').waitFor();
  assert.equal((await seen.figures()).nodes, 0);
  assert.ok(!(await seen.page.evaluate(() => navigator.serviceWorker.getRegistration())));
  await seen.close();
});

test('a web server whose /login is no object is no palpate-viewer', async () => {
  server.first['/login'] = [[200, 'null']];
  const seen = await Seen.open(browser, address);
  await seen.page.getByText('There is no palpate-viewer here, and no model is named').waitFor();
  await seen.close();
});

test('without server and model the page asks for a file; files dropped or chosen replace each other', async () => {
  const seen = await Seen.open(browser, address);
  const offer = seen.page.locator('#offer');
  await offer.waitFor();
  assert.match(await offer.textContent(), /There is no palpate-viewer here, and no model is named/);
  await drop(seen, 'organ.h5');
  const fine = await seen.organ();
  assert.ok(await offer.isHidden());
  await press(seen);
  await drop(seen, 'coarser.h5');
  await seen.until('another organ', (f) => f.nodes < fine.nodes && f.toolId === null);
  assert.match(await state(seen), /coarser\.h5, in this page/);
  assert.ok((await press(seen)).largestDisplacement > 0.0015);
  await seen.page.locator('#model-file').setInputFiles(join(scratch, 'organ.h5'));
  await seen.until('the first one again', (f) => f.nodes === fine.nodes);
  await press(seen);
  await seen.close();
});

test('a dropped file that is no model is refused, and the organ stays', async () => {
  const seen = await Seen.open(browser, `${address}?model=organ.h5`);
  await seen.organ();
  await drop(seen, 'favicon.svg');
  await seen.page.getByText('favicon.svg is no model file: it does not begin as HDF5 does.').waitFor();
  await press(seen);
  const cut = await seen.page.evaluateHandle(async () => {
    const transfer = new DataTransfer();
    transfer.items.add(new File([await (await (await fetch('organ.h5')).blob()).slice(0, 3000)], 'cut.h5'));
    return transfer;
  });
  await seen.page.dispatchEvent('#organ', 'drop', { dataTransfer: cut });
  await seen.page.locator('#offer').waitFor();
  assert.match(await state(seen), /cut\.h5/);
  await drop(seen, 'organ.h5');
  await seen.until('an organ again', (f) => f.state.level === 'good');
  await press(seen);
  await seen.close();
});

test('a machine that can vibrate does so at each contact, unless the switch says no, which is remembered', async () => {
  const seen = await Seen.open(browser, 'about:blank');
  await seen.context.addInitScript(() => {
    window.pulses = [];
    navigator.vibrate = (ms) => window.pulses.push(ms) > 0;
  });
  const pulses = () => seen.page.evaluate(() => window.pulses);
  const rest = () => seen.until('at rest', (f) => f.force === 0 && f.toolId === null);
  await seen.page.goto(`${address}?model=organ.h5`);
  await seen.organ();
  assert.deepEqual(await pulses(), []);
  for (const times of [1, 2]) {
    await press(seen);
    await rest();
    assert.equal((await pulses()).length, times);
  }
  await seen.page.getByLabel('Vibrate at contact').uncheck();
  await seen.page.reload();
  await seen.organ();
  assert.ok(!(await seen.page.getByLabel('Vibrate at contact').isChecked()));
  await press(seen);
  assert.deepEqual(await pulses(), []);
  await seen.close();
});

test('finger, pen and keyboard, colours and the inside are as with a server', async () => {
  const seen = await Seen.open(browser, `${address}?model=organ.h5`, { phone: true });
  await seen.organ();
  const wide = await seen.page.evaluate(() => document.documentElement.scrollWidth - innerWidth);
  assert.ok(wide <= 0, `the page is ${wide} px too wide`);
  const middle = await seen.middle();
  const device = await seen.context.newCDPSession(seen.page);
  const rest = () => seen.until('at rest', (f) => f.force === 0 && f.toolId === null);
  await device.send('Input.dispatchTouchEvent', { type: 'touchStart', touchPoints: [{ x: middle.x, y: middle.y }] });
  await seen.until('a force under the finger', (f) => f.pressing && f.force > 0.2);
  await seen.shot('alone-phone');
  await device.send('Input.dispatchTouchEvent', { type: 'touchEnd', touchPoints: [] });
  await rest();
  const pen = { x: middle.x, y: middle.y, button: 'left', clickCount: 1, pointerType: 'pen' };
  await device.send('Input.dispatchMouseEvent', { type: 'mousePressed', ...pen });
  await seen.until('a force under the pen', (f) => f.pressing && f.force > 0.2);
  await device.send('Input.dispatchMouseEvent', { type: 'mouseReleased', ...pen });
  await rest();
  await seen.page.locator('#organ').focus();
  await seen.page.keyboard.down('Enter');
  await seen.until('a force by key', (f) => f.pressing && f.force > 0.2);
  await seen.page.keyboard.up('Enter');
  await rest();
  assert.match((await seen.page.locator('#parts p').allTextContents()).join(), /clamped,cannot be touched,elsewhere .* kPa,nodule .* kPa/);
  const look = async () => meanOf(await seen.around(middle, 12));
  await seen.settled();
  const outside = await look();
  await seen.page.locator('input[value=stiffness]').check({ force: true });
  await seen.settled();
  const felt = await look();
  assert.ok(Math.max(...felt.map((v, k) => Math.abs(v - outside[k]))) > 10, `felt ${felt}, before ${outside}`);
  await seen.page.getByLabel(/^Show inside/).check();
  await seen.settled();
  assert.notDeepEqual(await look(), felt);
  await seen.page.locator('#friction').fill('1');
  await seen.until('more friction', (f) => f.inForce.friction === 1);
  await seen.close();
});
