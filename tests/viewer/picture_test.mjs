// SPDX-License-Identifier: Apache-2.0
// Makes the picture that README.md shows: of the demo's liver where it has been solved, else of the tests' organ.
import assert from 'node:assert/strict';
import { existsSync, statSync } from 'node:fs';
import { join } from 'node:path';
import { fileURLToPath } from 'node:url';
import { test } from 'node:test';
import { Seen } from './support/browser.mjs';
import { bench, browser, viewer, stage } from './support/stage.mjs';

const liver = process.env.PALPATE_TEST_MODEL ?? fileURLToPath(new URL('../../build/demo/liver.h5', import.meta.url));
stage({ model: () => (existsSync(liver) ? liver : bench.model()), server: ['--force-limit', '22'] });

for (const dark of [false, true])
  test(`the page during a press, ${dark ? 'dark' : 'light'}`, async () => {
    const seen = await Seen.open(browser, viewer.address, { width: 1280, height: 800, dark });
    await seen.organ();
    const { x, y } = await seen.middle();
    const place = { x: x + 40, y: y - 60 };
    await seen.page.mouse.move(place.x, place.y);
    await seen.page.mouse.down();
    await seen.until('pressed', (f) => f.penetration > 0.0035);
    await seen.page.mouse.up();
    await seen.until('at rest', (f) => f.force === 0);
    await seen.page.mouse.down();
    await seen.until('pressed again', (f) => f.penetration > 0.0035);
    for (let i = 0; i < 20; ++i) await seen.page.mouse.move(place.x + 3 * i, place.y + i);
    await seen.page.waitForTimeout(600);
    const name = dark ? 'page-dark' : 'page';
    await seen.shot(name);
    await seen.page.mouse.up();
    assert.ok(statSync(join(process.env.PALPATE_SHOTS, `${name}.png`)).size > 20_000);
    await seen.close();
  });
