// SPDX-License-Identifier: Apache-2.0
// node hostile.mjs WASM_FOLDER NODE_MODULES SCRATCH: files that claim more than they hold are refused before memory is taken.
import assert from 'node:assert/strict';
import { readFileSync, statSync } from 'node:fs';
import { join, resolve } from 'node:path';
import { pathToFileURL } from 'node:url';

import { makeOrgan } from '../../../core/wasm/organ.mjs';

const [folder, modules, scratch] = process.argv.slice(2).map((path) => resolve(path));
globalThis.self ??= { location: { href: import.meta.url } }; // emscripten's code is made for a worker
const { default: makeModule } = await import(pathToFileURL(join(folder, 'palpate_core.mjs')).href);
const { default: h5wasm } = await import(pathToFileURL(join(modules, 'h5wasm/dist/node/hdf5_hl.js')).href);
const hdf5 = await h5wasm.ready;

/** A file of 1 MB, and in it /contact/force of so many bytes, in chunks that were never written. */
function fileOf(name, bytes) {
  const path = join(scratch, name);
  const file = new h5wasm.File(path, 'w');
  file.create_dataset({ name: 'filling', data: new Uint8Array(1e6) });
  const group = file.create_group('contact');
  group.create_dataset({ name: 'force', data: new Uint8Array(8), shape: [8], maxshape: [null], chunks: [1000] }).resize([bytes]);
  file.close();
  return path;
}

/** What is said of a file, and the memory of JavaScript and WebAssembly that was taken for it, bytes. */
async function refusal(path) {
  const settings = { wasmBinary: readFileSync(join(folder, 'palpate_core.wasm')) };
  const before = process.memoryUsage();
  const size = statSync(path).size;
  const said = await makeOrgan(makeModule, settings, hdf5, new h5wasm.File(path, 'r'), size, path).then(() => 'no', (error) => error.message);
  const after = process.memoryUsage();
  return { said, size, taken: after.rss - before.rss };
}

for (const [name, bytes] of [['claims_900_MB.h5', 900_000_000], ['claims_more_than_32_bits.h5', 2 ** 32 + 8]]) {
  const { said, size, taken } = await refusal(fileOf(name, bytes));
  assert.equal(said, `${join(scratch, name)}: /contact/force has ${bytes} bytes, more than the file's ${size} can hold`);
  assert.ok(taken < 200e6, `${name}: ${taken} bytes of memory`);
  console.log(`${name}: refused, ${(taken / 1e6).toFixed(0)} MB taken`);
}
assert.match((await refusal(fileOf('chunked.h5', 700_000))).said, /chunked\.h5: \/contact\/force is chunked, expected contiguous/);
