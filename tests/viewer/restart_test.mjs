// SPDX-License-Identifier: Apache-2.0
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { Seen } from './support/browser.mjs';
import { bench, browser, stage } from './support/stage.mjs';

stage({ serve: false });

/** Presses where the mouse is until there is a force. */
async function press(seen) {
  await seen.page.mouse.down();
  await seen.until('a force', (f) => f.force > 0.2);
}

/** After the server is gone the page shows nothing of it: no force, no slider, no number. */
async function staysEmpty(seen, seconds) {
  for (const end = Date.now() + 1000 * seconds; Date.now() < end; await seen.page.waitForTimeout(100)) {
    const { force, tools, samples, largestDisplacement, state } = await seen.figures();
    assert.deepEqual([force, tools, samples, largestDisplacement], [0, 0, 0, 0], state.text);
    assert.equal(state.level, 'bad', state.text);
    for (const id of ['#stiffness', '#friction']) assert.ok(await seen.page.locator(id).isDisabled(), `${id}: ${state.text}`);
  }
  const panel = await seen.panel();
  assert.deepEqual([panel['Server'], panel['Ticks missed'], panel['Real time']], ['–', '–', '–']);
  assert.match(panel['Force limit'], /^–/);
}

test('it says what it waits for, and comes back when the server or the viewer does', async () => {
  const viewer = await bench.viewer();
  const seen = await Seen.open(browser, viewer.address);
  const state = () => seen.page.locator('#state-text').textContent();

  // 1. No server yet.
  await seen.until('waiting is said', (f) => f.state.level === 'wait' && /waiting/i.test(f.state.text));
  assert.ok(await seen.page.locator('#stiffness').isDisabled());

  // 2. One comes.
  const first = await bench.server(bench.model(4));
  const before = await seen.until('the organ', (f) => f.nodes === 2562 && f.state.level === 'good');

  // 3. It is killed during a press: the page shows no force of a server that is gone.
  const middle = await seen.middle();
  await seen.page.mouse.move(middle.x, middle.y);
  await press(seen);
  assert.ok(await seen.page.locator('#stiffness').isEnabled());
  await first.stop('SIGKILL');
  await seen.until('gone is said', (f) => f.state.level === 'bad' && f.force === 0);
  assert.match(await state(), /gone|no word from the server/i);
  await staysEmpty(seen, 3); // the viewer repeats the last words of the server once a second
  await seen.page.mouse.up();

  // 4. Another comes, with another organ.
  await bench.server(bench.model(3));
  const after = await seen.until('the other organ', (f) => f.nodes === 642 && f.state.level === 'good');
  assert.ok(after.meshRevision > before.meshRevision);
  await press(seen);

  // 5. The viewer itself ends during a press, and comes back at the same address.
  const port = Number(new URL(viewer.address).port);
  await viewer.stop('SIGKILL');
  await seen.until('no line is said', (f) => f.state.level === 'bad' && /viewer/.test(f.state.text));
  await staysEmpty(seen, 1);
  await seen.page.mouse.up();
  await bench.viewer(port);
  // Nothing touches the organ, so its field comes once a second.
  await seen.until('back again', (f) => f.state.level === 'good' && f.framesPerSecond > 0);
  assert.ok(!(await seen.figures()).pressing);
  await press(seen);
  await seen.page.mouse.up();
  await seen.close();
});
