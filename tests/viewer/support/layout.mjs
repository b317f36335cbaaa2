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

/** Asserts what is to hold once the page has come to its new size: until it does, for at most 10 s. */
export async function laidOut(page, holds) {
  for (const end = Date.now() + 10_000; Date.now() < end; await page.waitForTimeout(100))
    try {
      return await holds();
    } catch (error) {
      if (error.code !== 'ERR_ASSERTION') throw error;
    }
  await holds();
}

const overlap = (a, b) =>
  a && b && a.x < b.x + b.width && b.x < a.x + a.width && a.y < b.y + b.height && b.y < a.y + a.height;

/**
 * @param there  selectors of what must be seen; other things that are not seen are over nothing
 * @throws AssertionError where two of a pair are over each other
 */
export async function assertApart(page, pairs, there) {
  for (const selector of there) assert.ok(await page.locator(selector).isVisible(), `${selector} is not seen`);
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
