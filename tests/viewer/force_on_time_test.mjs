// SPDX-License-Identifier: Apache-2.0
// Four pages that watch do not make a device's force later.
import assert from 'node:assert/strict';
import { execFile } from 'node:child_process';
import { test } from 'node:test';
import { promisify } from 'node:util';
import { Seen } from './support/browser.mjs';
import { measured, median, rounds } from './support/measured.mjs';
import { bin } from './support/processes.mjs';
import { bench, browser, viewer, stage } from './support/stage.mjs';

const run = promisify(execFile);
const ROUNDS = rounds(2, 5);
stage({ model: () => process.env.PALPATE_TEST_MODEL ?? bench.model() });

async function measure() {
  const { stdout } = await run(bin('palpate-latency'), ['--seconds', '4', '--domain', String(bench.domain), '--json']);
  return JSON.parse(stdout);
}

/** Once without and once with four pages that watch. */
async function round(without, beside) {
  without.push(await measure());
  const pages = [];
  for (let i = 0; i < 4; ++i) pages.push(await Seen.open(browser, viewer.address, { width: 700, height: 500 }));
  for (const seen of pages) await seen.organ();
  beside.push(await measure());
  for (const seen of pages) await seen.close();
}

const p99 = (runs) => runs.map((run) => run.pose_to_force_us.p99);
const ratioOf = (without, beside) => median(p99(beside)) / median(p99(without));

test('four pages do not make the force of a headless tool late', async (t) => {
  const [without, beside] = [[], []];
  for (let i = 0; i < ROUNDS; ++i) await round(without, beside);
  const list = (values) => values.map((v) => v.toFixed(0)).join(', ');
  console.log(`pose to force, p99 / us, without: ${list(p99(without))}; with four pages: ${list(p99(beside))}`);
  if (!without[0].server_realtime || !without[0].client_realtime) {
    console.log(`the ratio of the medians: ${ratioOf(without, beside).toFixed(2)}`);
    console.log('SKIPPED: real time not granted'); // the word that ctest looks for; without real time the figures say nothing
    return t.skip('real time not granted');
  }
  measured('force p99 with four pages, medians', ratioOf(without, beside), 1.2, 'x that without');
});
