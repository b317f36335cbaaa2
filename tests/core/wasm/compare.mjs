// SPDX-License-Identifier: Apache-2.0
// node compare.mjs WASM_FOLDER NODE_MODULES MODEL ANSWERS: core as WebAssembly against core_answers' file of the same model.
// Prints the largest differences, and ends with 1 where one is larger than it may be.
import { createHash } from 'node:crypto';
import { readFileSync } from 'node:fs';
import { join, resolve } from 'node:path';
import { pathToFileURL } from 'node:url';

import { makeOrgan } from '../../../core/wasm/organ.mjs';

const [folder, modules, modelPath, answersPath] = process.argv.slice(2).map((path) => resolve(path));
globalThis.self ??= { location: { href: import.meta.url } }; // emscripten's code is made for a worker
const { default: makeModule } = await import(pathToFileURL(join(folder, 'palpate_core.mjs')).href);
const hdf5 = await import(pathToFileURL(join(modules, 'jsfive/dist/esm/index.mjs')).href);

const sha256 = (bytes) => createHash('sha256').update(bytes).digest();
const began = performance.now();
const bytes = new Uint8Array(readFileSync(modelPath)).buffer;
const settings = { sha256, wasmBinary: readFileSync(join(folder, 'palpate_core.wasm')) };
const organ = await makeOrgan(makeModule, settings, hdf5, bytes, modelPath);
console.log(`model ${organ.id}: loaded in ${(performance.now() - began).toFixed(0)} ms`);

const data = readFileSync(answersPath);
let at = 0;
const integer = () => data.readInt32LE((at += 4) - 4);
const doubles = (count) => Array.from({ length: count }, () => data.readDoubleLE((at += 8) - 8));
const [touches, nodes, ticks, inputBytes, resultBytes] = Array.from({ length: 6 }, integer);
const [nativeUs] = doubles(1);
const bad = [];
const hold = (what, found, most) => {
  console.log(`${what}: ${found.toExponential(2)}, at most ${most}`);
  if (!(found <= most)) bad.push(what);
};
const size = (v) => Math.hypot(...v);
const apart = (a, b) => Math.hypot(...a.map((x, i) => x - b[i]));
if (nodes !== organ.nodes || inputBytes !== organ.inputBytes || resultBytes !== organ.resultBytes)
  throw new Error('the two sides are of different models or engines');

let force = 0, stiffness = 0, field = 0, statuses = 0;
for (let i = 0; i < touches; ++i) {
  const triangle = integer(), status = integer(), barycentric = doubles(3), d = doubles(3), expected = doubles(18);
  const { status: found, values } = organ.respond(triangle, barycentric, d);
  const answer = Array.from(values);
  statuses += found === status ? 0 : 1;
  force = Math.max(force, apart(answer.slice(0, 3), expected.slice(0, 3)) / size(expected.slice(0, 3)));
  stiffness = Math.max(stiffness, apart(answer.slice(3, 12), expected.slice(3, 12)) / size(expected.slice(3, 12)));
  const u = organ.field(triangle, barycentric, d);
  let largest = size(expected.slice(12, 15)), off = 0; // under the tool too
  for (let k = 0; k < 3 * nodes; ++k, at += 4) {
    const there = data.readFloatLE(at);
    largest = Math.max(largest, Math.abs(there));
    off = Math.max(off, Math.abs(there - u[k]));
  }
  field = Math.max(field, off / largest);
}
hold(`${touches} touches: statuses that differ`, statuses, 0);
hold('force, relative', force, 1e-9);
hold('stiffness, relative', stiffness, 1e-7);
hold('field, of its largest displacement', field, 1e-5);

const steps = [], off = [];
let largest = 0;
const forceOf = (bytes) => {
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.length);
  return [8, 16, 24].map((place) => view.getFloat64(place, true));
};
for (let i = 0; i < ticks; ++i) {
  organ.input.set(data.subarray(at, at + inputBytes));
  const start = performance.now();
  organ.step();
  steps.push(1000 * (performance.now() - start));
  const expected = forceOf(data.subarray(at + inputBytes, at + inputBytes + resultBytes));
  largest = Math.max(largest, size(expected));
  off.push(apart(forceOf(organ.result), expected));
  at += inputBytes + resultBytes;
}
const quantile = (values, q) => [...values].sort((a, b) => a - b)[Math.min(values.length - 1, Math.floor(q * values.length))];
if (!(largest > 0)) bad.push('the session touches nothing');
hold(`${ticks} ticks: force, 99 %, of the largest, ${largest.toPrecision(3)} N`, quantile(off, 0.99) / largest, 1e-4);
console.log(`step(): ${quantile(steps, 0.5).toFixed(1)} us (p50), ${quantile(steps, 0.99).toFixed(1)} us (p99); native ${nativeUs.toFixed(1)} us`);
hold('step(), p50, of the native one of this run', quantile(steps, 0.5) / nativeUs, 4);
if (bad.length > 0) console.log(`FAILED: ${bad.join('; ')}`);
process.exitCode = bad.length > 0 ? 1 : 0;
