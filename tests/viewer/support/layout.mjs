// SPDX-License-Identifier: Apache-2.0
// Where things are on the page, and at which sizes they are looked at.
import assert from 'node:assert/strict';

export const SIZES = [[320, 568], [390, 844], [1280, 800]];

/** Calls look(width, dark) with the page at each size, light and dark. */
export async function atEverySize(seen, look) {
  for (const [width, height] of SIZES) {
    await seen.page.setViewportSize({ width, height });
    for (const dark of [false, true]) {
      await seen.page.emulateMedia({ colorScheme: dark ? 'dark' : 'light' });
      await look(width, dark);
    }
  }
}

const overlap = (a, b) =>
  a && b && a.x < b.x + b.width && b.x < a.x + a.width && a.y < b.y + b.height && b.y < a.y + a.height;

/** @throws AssertionError where two of these are over each other, by selector; those not seen are over nothing */
export async function assertApart(page, pairs) {
  for (const [a, b] of pairs) {
    const [one, other] = await Promise.all([a, b].map((selector) => page.locator(selector).boundingBox()));
    assert.ok(!overlap(one, other), `${a} ${JSON.stringify(one)} is over ${b} ${JSON.stringify(other)}`);
  }
}

/** What a finger is to hit and is smaller than 44 px, by name. */
export const tooSmall = (page) =>
  page.evaluate(() => {
    const targets = [...document.querySelectorAll('button, select, summary, input[type=range], label:has(input)')];
    const box = (e) => e.getBoundingClientRect();
    return targets.filter((e) => box(e).width > 0 && (box(e).height < 43.5 || box(e).width < 43.5))
      .map((e) => `${e.id || e.textContent.trim()} ${box(e).width.toFixed(0)} x ${box(e).height.toFixed(0)}`);
  });
