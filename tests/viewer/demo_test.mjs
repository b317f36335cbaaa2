// SPDX-License-Identifier: Apache-2.0
// tools/demo --serve as a user starts it, but with the tests' organ, because solving the liver takes minutes.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { test } from 'node:test';
import { fileURLToPath } from 'node:url';
import { Seen } from './support/browser.mjs';
import { measured, median } from './support/measured.mjs';
import { Program } from './support/processes.mjs';
import { bench, browser, stage } from './support/stage.mjs';

const demo = fileURLToPath(new URL('../../tools/demo', import.meta.url));
stage({ serve: false });

/** Programs that run this model or look at this domain. */
const left = (mark) =>
  execFileSync('ps', ['-eo', 'args'], { encoding: 'utf8' }).split('\n').filter((line) => /palpate-(server|viewer)/.test(line) && line.includes(mark));

/** The demo, once it serves: {program, address, domain}. */
async function served() {
  const env = { ...process.env, PALPATE_DEMO_NO_BUILD: '1' }; // ctest runs what is built
  const program = new Program(demo, ['--serve', '--model', bench.model(), '--port', '0'], { env });
  bench.programs.push(program);
  const address = (await program.says(/page at (\S+)/, 120))[1];
  const domain = (await program.says(/DDS domain (\d+)/))[1];
  return { program, address, domain };
}

test('tools/demo --serve serves a page that shows the organ, and Ctrl-C ends all of it', async () => {
  const { program, address, domain } = await served();
  const times = [];
  for (let attempt = 0; attempt < 3; ++attempt) {
    const seen = await Seen.open(browser, address);
    times.push((await seen.organ()).organSeenMs);
    await seen.close();
  }
  measured('organ seen after loading', median(times), 3000, 'ms');
  assert.equal(left(`--domain ${domain} `).length, 2);
  assert.equal(await program.stop('SIGINT'), 0, program.log);
  assert.deepEqual(left(`--domain ${domain} `), []);
  await assert.rejects(fetch(address));
});

test('what a test does with a demo that it leaves behind ends all of it', async () => {
  const { program, domain } = await served();
  assert.equal(left(`--domain ${domain} `).length, 2);
  assert.equal(await program.end(), 143, program.log);
  assert.deepEqual(left(`--domain ${domain} `), []);
});
