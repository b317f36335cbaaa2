// SPDX-License-Identifier: Apache-2.0
import assert from 'node:assert/strict';
import { existsSync } from 'node:fs';
import { request } from 'node:http';
import { test } from 'node:test';
import { packageOf } from './support/browser.mjs';
import { seen, viewer, stage } from './support/stage.mjs';

stage({ page: 'once' });
const WebSocket = packageOf('ws');

const origin = () => viewer.address.replace(/\/$/, '');
/** A client that is no page. @return how its connection ended: {http} or {code} */
function intrude({ from = origin(), act = () => {}, seconds = 10 } = {}) {
  return new Promise((resolve) => {
    const socket = new WebSocket(viewer.address.replace('http', 'ws') + 'ws', 'palpate.viewer.v1', { origin: from });
    const timer = setTimeout(() => resolve({ open: true }) || socket.terminate(), 1000 * seconds);
    const end = (how) => (clearTimeout(timer), resolve(how));
    socket.on('unexpected-response', (_, response) => end({ http: response.statusCode }));
    socket.on('open', () => act(socket));
    socket.on('close', (code) => end({ code }));
    socket.on('error', () => {});
  });
}

/** What is refused; and the page beside it sees frames go on and feels the organ all the while. */
async function refused(what, attack, judge) {
  const before = await seen.figures();
  const middle = await seen.middle();
  await seen.page.mouse.move(middle.x, middle.y);
  await seen.page.mouse.down();
  const end = await attack();
  assert.ok(judge(end), `${what}: ${JSON.stringify(end)}`);
  const now = await seen.until(`frames and a force beside ${what}`, (f) => f.frames > before.frames + 10 && f.force > 0.2);
  await seen.page.mouse.up();
  assert.equal(now.state.level, 'good');
  await seen.until('at rest', (f) => f.force === 0);
}

test('another site is refused', () =>
  refused('a wrong origin', () => intrude({ from: 'http://elsewhere.example' }), (end) => end.http === 403));

test('no origin is refused', () => refused('no origin', () => intrude({ from: '' }), (end) => end.http === 403));

test('a huge message ends its connection', () =>
  refused('a huge frame', () => intrude({ act: (s) => s.send('x'.repeat(1_000_000)) }), (end) => end.code === 1009 || end.code === 1006));

test('garbage ends its connection', () => refused('garbage', () => intrude({ act: (s) => s.send('{"type":"gr') }), (end) => end.code === 1008));

test('binary ends its connection', () =>
  refused('binary', () => intrude({ act: (s) => s.send(Buffer.from([1, 2, 3])) }), (end) => end.code === 1003));

test('a number that is not finite ends its connection', () =>
  refused('infinity', () => intrude({ act: (s) => s.send('{"type":"target","position":[0,0,1e999]}') }), (end) => end.code === 1008));

test('a flood ends its connection', () =>
  refused('a flood', () => intrude({ act: (s) => { for (let i = 0; i < 5000; ++i) s.send('{"type":"ping","t0":1}'); } }),
    (end) => end.code === 1008 || end.code === 1006));

test('one that never acknowledges gets two frames and no more', async () => {
  let frames = 0;
  await refused('silence', () => intrude({ seconds: 2, act: (s) => s.on('message', (data, binary) => {
    if (binary && data.readUInt32LE(0) === 2) ++frames;
  }) }), (end) => end.open === true);
  assert.equal(frames, 2);
});

/** What comes for a path that is sent as it stands: fetch and browsers would straighten it first. */
function got(path) {
  const { hostname, port } = new URL(viewer.address);
  return new Promise((resolve) => {
    const asked = request({ hostname, port, path, agent: false }, (response) => {
      let body = '';
      response.on('data', (data) => (body += data));
      response.on('close', () => resolve({ status: response.statusCode, body }));
    });
    asked.on('error', (error) => resolve({ status: 0, body: error.message }));
    asked.end();
  });
}

test('files outside the page are not served', async () => {
  assert.ok(existsSync(new URL('../../clients/viewer/web/package.json', import.meta.url)), 'beside dist there is a file to steal');
  assert.deepEqual([(await got('/index.html')).status, (await got('/')).status], [200, 200]);
  for (const path of ['/../package.json', '/..%2fpackage.json', '/%2e%2e/package.json', '/%2e%2e%2fpackage.json', '/assets/../../package.json',
    '/assets/%2e%2e/%2e%2e/package.json', '/..%5cpackage.json', '//../package.json', '../package.json', '/%252e%252e/package.json']) {
    const { status, body } = await got(path);
    assert.notEqual(status, 200, path);
    assert.doesNotMatch(body, /palpate-viewer-page/, path);
  }
});

test('the page may not be told to run what others wrote', async () => {
  const head = (await fetch(viewer.address)).headers;
  assert.match(head.get('content-security-policy'), /default-src 'none'; script-src 'self'/);
  assert.doesNotMatch(head.get('content-security-policy'), /unsafe-/);
  assert.equal(head.get('x-content-type-options'), 'nosniff');
  const ran = await seen.page.evaluate(() => {
    const script = document.createElement('script');
    script.textContent = 'window.stranger = 1';
    document.body.append(script);
    return window.stranger === 1;
  });
  assert.equal(ran, false);
  assert.match(seen.errors.pop() ?? '', /content security policy/i); // and it was seen: a violation of the page's own would fail its test
});
