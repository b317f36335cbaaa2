// SPDX-License-Identifier: Apache-2.0
import assert from 'node:assert/strict';
import { mock, test } from 'node:test';

Object.assign(globalThis, { location: { href: 'http://localhost/index.html' } });
const { Keeping } = await import('../src/keeping');

test('a named model is kept when its organ comes, and not when another file was opened instead', () => {
  const copies = mock.method(globalThis, 'setTimeout', () => 0);
  const keeping = new Keeping(() => false, () => undefined);
  const named = (model: string, forgotten: boolean): void => {
    keeping.want(model);
    if (forgotten) keeping.forget();
    keeping.organCame();
  };
  named('http://localhost/gone.h5', true);
  assert.deepEqual([keeping.last, copies.mock.callCount()], ['', 0]);
  named('http://localhost/liver.h5', false);
  assert.deepEqual([keeping.last, copies.mock.callCount()], ['http://localhost/liver.h5', 1]);
  named('http://localhost/gone.h5', true);
  assert.deepEqual([keeping.last, copies.mock.callCount()], ['http://localhost/liver.h5', 1]);
  mock.restoreAll();
});
