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

/** A file of 1 MB that says what it is, and in it /contact/force, which `make` makes in the group contact. */
function fileOf(name, make, format = 'palpate-model') {
  const path = join(scratch, name);
  const file = new h5wasm.File(path, 'w');
  file.create_dataset({ name: 'filling', data: new Uint8Array(1e6) });
  file.create_attribute('format', format);
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
await says(whole.subarray(0, 100), /^given\.h5 is no HDF5 file/);
await says(Buffer.alloc(5000, 'x'), /^given\.h5 is no HDF5 file/);
