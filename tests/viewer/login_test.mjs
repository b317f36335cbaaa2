// SPDX-License-Identifier: Apache-2.0
// A viewer with a token, over https where openssl makes a certificate: how people come in.
import assert from 'node:assert/strict';
import { spawnSync } from 'node:child_process';
import { writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { test } from 'node:test';
import { Seen } from './support/browser.mjs';
import { bench, browser, stage, viewer } from './support/stage.mjs';

const TOKEN = 'a-token-of-this-test-0123';
let options;
stage({ model: () => bench.model(3), more: () => (options = [...tokenFile(), ...certificate()]) });

function tokenFile() {
  const file = join(bench.folder, 'token');
  writeFileSync(file, TOKEN);
  return ['--token-file', file];
}

/** Options of a certificate that signed itself; none where openssl is absent. */
function certificate() {
  const [cert, key] = ['cert.pem', 'key.pem'].map((name) => join(bench.folder, name));
  const made = spawnSync('openssl', ['req', '-x509', '-newkey', 'ec', '-pkeyopt', 'ec_paramgen_curve:prime256v1', '-nodes',
    '-keyout', key, '-out', cert, '-days', '1', '-subj', '/CN=localhost', '-addext', 'subjectAltName=IP:127.0.0.1']);
  return made.status === 0 ? ['--tls-cert', cert, '--tls-key', key] : [];
}

const form = (seen) => seen.page.locator('#login');
const open = () => Seen.open(browser, new URL(viewer.address).origin);
const cookieOf = async (seen) => (await seen.context.cookies()).find((cookie) => cookie.name.startsWith('palpate-viewer'));

test('the printed address lets one browser in, and its code leaves the address', async () => {
  assert.match(viewer.address, /#code=/);
  const seen = await Seen.open(browser, viewer.address);
  await seen.organ();
  assert.equal(await form(seen).isVisible(), false);
  assert.equal(seen.page.url(), new URL(viewer.address).origin + '/');
  const cookie = await cookieOf(seen);
  assert.deepEqual([cookie.httpOnly, cookie.sameSite, cookie.secure], [true, 'Strict', viewer.address.startsWith('https:')]);
  assert.doesNotMatch(await seen.page.evaluate(() => document.cookie), /palpate/, 'scripts do not see it');
  await seen.page.reload();
  await seen.organ();
  await seen.close();
});

test('a second browser with the same address is asked for the token', async () => {
  const seen = await Seen.open(browser, viewer.address);
  await form(seen).waitFor();
  assert.match(await seen.page.locator('#login-message').textContent(), /code was used/);
  await seen.close();
});

test('a wrong token is refused in words, and the right one opens the page', async () => {
  const seen = await open();
  await form(seen).waitFor();
  await seen.shot('login');
  for (const [token, said] of [['a-token-of-this-test-0124', /wrong/], ['no t\u00f6ken', /letters/]]) {
    await seen.page.locator('#token').fill(token);
    await seen.page.keyboard.press('Enter');
    await seen.page.locator('#login-message').filter({ hasText: said }).waitFor();
  }
  assert.equal((await seen.figures()).nodes, 0);
  await seen.page.locator('#token').fill(TOKEN);
  await seen.page.keyboard.press('Enter');
  await seen.organ();
  assert.equal(await form(seen).isVisible(), false);
  assert.doesNotMatch(seen.page.url(), /token|code/);
  await seen.close();
});

test('a page whose cookie no longer fits asks again', async () => {
  const seen = await open();
  await form(seen).waitFor();
  await seen.page.locator('#token').fill(TOKEN);
  await seen.page.keyboard.press('Enter');
  await seen.organ();
  await seen.context.clearCookies();
  const port = Number(new URL(viewer.address).port);
  await viewer.stop('SIGKILL'); // the line breaks; the viewer comes back
  await bench.viewer(port, options);
  await form(seen).waitFor();
  await seen.close();
});

test('the token is in nothing that was written', () => {
  for (const program of bench.programs) assert.doesNotMatch(program.log, new RegExp(TOKEN));
});
