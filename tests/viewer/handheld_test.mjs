// SPDX-License-Identifier: Apache-2.0
// The page on a machine of a quarter of a core, drawing included, with a model for small machines: PALPATE_HANDHELD_MODEL, or
// one that palpate-solve makes in seconds.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { mkdtempSync, rmSync, statSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, test } from 'node:test';
import { aloneStage, browser, exported, scratch } from './support/alone.mjs';
import { CHROMIUM, openBrowser, Seen } from './support/browser.mjs';
import { measured, measuredAtLeast, median } from './support/measured.mjs';
import { bin } from './support/processes.mjs';
import { quarterOfACore } from './support/quarter_core.mjs';
import { StaticServer } from './support/static_server.mjs';

const MOST_BYTES = 8e6;
const SLIDE_MS = 8000;

const folder = mkdtempSync(join(tmpdir(), 'palpate-quarter-'));
const quarter = quarterOfACore(folder, CHROMIUM);
if (quarter.lacks) {
  console.log(`SKIPPED: ${quarter.lacks}`);
  process.exit(0);
}
aloneStage(() => openBrowser(quarter.inside));
after(() => {
  quarter.remove();
  rmSync(folder, { recursive: true, force: true });
});

function handheldModel() {
  if (process.env.PALPATE_HANDHELD_MODEL) return process.env.PALPATE_HANDHELD_MODEL;
  const [mesh, model] = [join(scratch, 'organ.msh'), join(scratch, 'organ.h5')];
  execFileSync(bin('palpate-organ'), ['paper-liver', '-o', mesh, '--element-size', '0.02']);
  execFileSync(bin('palpate-solve'), [mesh, '-o', model, '--order', '3', '--element-order', '1'], { stdio: 'ignore' });
  return model;
}

test('a quarter of a core presses an organ within seconds, ticks in time and evaluates 25 fields a second', async () => {
  const model = handheldModel();
  assert.ok(statSync(model).size <= MOST_BYTES, `${model}: ${statSync(model).size} bytes`);
  const server = await StaticServer.open([exported('web', model)]);
  const seen = await Seen.open(browser, 'about:blank', { phone: true });
  const began = Date.now();
  await seen.page.goto(server.address, { waitUntil: 'commit' });
  await seen.until('an organ', (f) => f.nodes > 0 && f.organSeenMs > 0, 60);
  const middle = await seen.middle();
  await seen.page.mouse.move(middle.x, middle.y);
  await seen.page.mouse.down();
  const first = await seen.until('a force', (f) => f.force > 0.01, 30);
  const firstPress = (Date.now() - began) / 1000;
  const [fields, pictures] = [[], []]; // each second
  for (let i = 0, end = Date.now() + SLIDE_MS; Date.now() < end; ++i) {
    await seen.page.mouse.move(middle.x + 40 * Math.sin(0.15 * i), middle.y + 20 * Math.sin(0.11 * i));
    await seen.page.waitForTimeout(40);
    if (Date.now() < end - SLIDE_MS + 1000 * (fields.length + 2)) continue;
    const now = await seen.figures();
    fields.push(now.fieldsPerSecond);
    pictures.push(now.picturesPerSecond);
  }
  const figures = await seen.figures();
  await seen.page.mouse.up();
  console.log(`  ${first.nodes} nodes, ${(statSync(model).size / 1e6).toFixed(1)} MB, ${figures.ticks} ticks`);
  console.log(`  pictures a second: ${median(pictures).toFixed(0)}; step() p50 ${figures.tickUs.p50.toFixed(0)} us`);
  assert.ok(figures.ticks > 0.5 * SLIDE_MS, `${figures.ticks} ticks`);
  measured('from loading to the first press', firstPress, 5, 's');
  measured('step(), p99', figures.tickUs.p99 / 1000, 2, 'ms');
  measuredAtLeast('fields evaluated', median(fields), 25, '1/s');
  await seen.close();
  await server.close();
});
