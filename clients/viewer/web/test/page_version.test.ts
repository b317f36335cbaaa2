// SPDX-License-Identifier: Apache-2.0
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { isOfThisVersion, PROTOCOL } from '../src/page_version';

test('a page of another protocol than the viewer is loaded again, once for each', () => {
  const kept = new Map<string, string>();
  const store = { getItem: (key: string) => kept.get(key) ?? null, setItem: (key: string, value: string) => void kept.set(key, value) };
  let loaded = 0;
  const hears = (protocol: number | undefined): boolean => isOfThisVersion({ type: 'hello', protocol }, store, () => ++loaded);
  assert.ok(hears(PROTOCOL));
  assert.equal(loaded, 0);
  assert.ok(!hears(PROTOCOL + 1));
  assert.equal(loaded, 1);
  assert.ok(!hears(PROTOCOL + 1));
  assert.equal(loaded, 1, 'it does not turn in circles');
  assert.ok(!hears(undefined));
  assert.equal(loaded, 2);
});
