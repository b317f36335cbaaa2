// SPDX-License-Identifier: Apache-2.0
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { inRows } from '../src/picture';

test('what stands side by side in a picture goes on in the next row where the picture ends', () => {
  const widths = [95, 190, 130, 145]; // clamped, cannot be touched, two tissues with their E, 14 px type
  const at = (room: number): string => inRows(widths, room).map(({ x, row }) => `${row}:${x}`).join(' ');
  assert.equal(at(1000), '0:0 0:95 0:285 0:415');
  assert.equal(at(304), '0:0 0:95 1:0 1:130'); // of a page of 320 px
  assert.equal(at(100), '0:0 1:0 2:0 3:0', 'what is wider than the picture has a row of its own');
  assert.deepEqual(inRows([], 100), []);
});
