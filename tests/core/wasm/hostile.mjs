// SPDX-License-Identifier: Apache-2.0
// node hostile.mjs WASM_FOLDER NODE_MODULES SCRATCH: files that are no model, or claim more than they hold, are refused before
// memory is taken.
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { join, resolve } from 'node:path';
import { pathToFileURL } from 'node:url';

import { makeOrgan } from '../../../core/wasm/organ.mjs';

const [folder, modules, scratch] = process.argv.slice(2).map((path) => resolve(path));
globalThis.self ??= { location: { href: import.meta.url } }; // emscripten's code is made for a worker
const { default: makeModule } = await import(pathToFileURL(join(folder, 'palpate_core.mjs')).href);
const { default: h5wasm } = await import(pathToFileURL(join(modules, 'h5wasm/dist/node/hdf5_hl.js')).href);
const hdf5 = await import(pathToFileURL(join(modules, 'jsfive/dist/esm/index.mjs')).href);
await h5wasm.ready;

/**
 * A file of 1 MB that says what it is, and in it /contact/force, which `make` makes in the group contact.
 * @param texts  how many attributes of three texts it has besides
 */
function fileOf(name, make, format = 'palpate-model', texts = 0) {
  const path = join(scratch, name);
  const file = new h5wasm.File(path, 'w');
  file.create_dataset({ name: 'filling', data: new Uint8Array(1e6) });
  file.create_attribute('format', format);
  for (let k = 0; k < texts; ++k) file.create_attribute(`many${k}`, ['a', 'b', 'c'], [3], 'S77');
  make(file.create_group('contact'));
  file.close();
  return readFileSync(path);
}
const inChunks = (bytes) => (group) =>
  group.create_dataset({ name: 'force', data: new Uint8Array(8), shape: [8], maxshape: [null], chunks: [1000] }).resize([bytes]);
const inOnePiece = (group) => group.create_dataset({ name: 'force', data: new Uint8Array(400_000).fill(7) });

/** What is said of a file, and the memory of JavaScript and WebAssembly that was taken for it, bytes. */
async function refusal(file, name) {
  const settings = { wasmBinary: readFileSync(join(folder, 'palpate_core.wasm')) };
  const bytes = new Uint8Array(file).buffer;
  const before = process.memoryUsage();
  const said = await makeOrgan(makeModule, settings, hdf5, bytes, name).then(() => 'no', (error) => error.message);
  return { said, taken: process.memoryUsage().rss - before.rss };
}

for (const [name, bytes] of [['claims_900_MB.h5', 900_000_000], ['claims_4_GB.h5', 2 ** 32 - 8]]) {
  const file = fileOf(name, inChunks(bytes));
  const { said, taken } = await refusal(file, name);
  assert.equal(said, `${name}: /contact/force has ${bytes} bytes, more than the file's ${file.length} can hold`);
  assert.ok(taken < 200e6, `${name}: ${taken} bytes of memory`);
  console.log(`${name}: refused, ${(taken / 1e6).toFixed(0)} MB taken`);
}
const says = async (file, words) => assert.match((await refusal(file, 'given.h5')).said, words);
await says(fileOf('chunked.h5', inChunks(700_000)), /^given\.h5: \/contact\/force is not in one piece, expected a contiguous dataset$/);
await says(fileOf('other.h5', inOnePiece, 'other-model'), /^given\.h5: attribute format is "other-model", expected "palpate-model"$/);
const whole = fileOf('whole.h5', inOnePiece);
await says(whole, /^given\.h5: attribute .* is missing$/); // read to the end, and handed over
await says(whole.subarray(0, whole.lastIndexOf(7) - 1000), /^given\.h5: \/contact\/force ends at byte \d+, beyond the file's \d+$/);
const noFile = /^given\.h5 is no HDF5 file, or a damaged one$/;
await says(whole.subarray(0, 100), noFile);
await says(Buffer.alloc(5000, 'x'), noFile);

// Attributes: three texts of 77 bytes become `count` of `bytes` each. Behind the name come type (its length at 4) and shape (at 12).
function withAttribute(count, bytes, copies = 1) {
  const file = fileOf('attribute.h5', inOnePiece, 'palpate-model', copies);
  for (let k = 0; k < copies; ++k) {
    const type = file.indexOf(`many${k}\0`) + 6;
    assert.deepEqual([file.readUInt32LE(type + 4), file.readBigUInt64LE(type + 12)], [77, 3n]);
    file.writeUInt32LE(bytes, type + 4);
    file.writeBigUInt64LE(BigInt(count), type + 12);
  }
  return file;
}
await says(withAttribute(3, 77), /^given\.h5: attribute .* is missing$/); // one that core does not know
for (const count of [1e7, 2 ** 32, 2 ** 60]) {
  const { said, taken } = await refusal(withAttribute(count, 0), 'given.h5');
  assert.equal(said, `given.h5: an attribute has ${count} values, expected one to three`);
  assert.ok(taken < 50e6, `${count} values of no bytes: ${taken} bytes of memory`);
}
await says(withAttribute(40_000, 0, 2), /^given\.h5: its attributes have more than 65536 values, expected one to three each$/);

/** The whole file with other bytes. @param at  where they begin, counted from the first `mark` behind the first `after` */
function changed(mark, at, bytes, after = '') {
  const file = Buffer.from(whole);
  const place = file.indexOf(mark, file.indexOf(after));
  assert.ok(place >= 0, `${mark} is not in the file`);
  file.set(bytes, place + at);
  return file;
}
const noAttributes = /^given\.h5: its attributes cannot be read: the file is damaged$/;
const noList = /^given\.h5: its list of datasets cannot be read: the file is damaged$/;
const layout = Buffer.from([8, 18, 0, 0, 3, 1]); // type, size and flags of the message, its version and class
await says(changed('OHDR', 0, [0]), noFile);
await says(changed('format', -9, [9]), noAttributes); // a version of attributes that there is not
await says(changed('contact', 7, [0, 0, 0, 0, 0, 0, 4, 0]), noList); // a group beyond the file's end
await says(changed('force', 5, [0]), noList); // a dataset where none begins
await says(changed(layout, 0, [0], 'force'), noList); // a dataset whose bytes lie nowhere
await says(changed(layout, 4, [9], 'force'), noList); // or in a way that there is not
