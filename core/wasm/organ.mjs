// SPDX-License-Identifier: Apache-2.0
// An organ in a page or in node: core as WebAssembly, with the bytes of a model file, which jsfive finds its way through.
import { checkPlace, datasetsOf, opened, reading } from './model_file.mjs';

/** The engine's memory and functions, with texts and arrays of numbers as arguments. */
class Engine {
  constructor(module) {
    this.module = module;
  }

  /** Calls work(address...) with copies of texts (zero-ended) and Float64Arrays in the engine's memory, and frees them. */
  with(things, work) {
    const places = things.map((thing) => this.copy(thing));
    try {
      return work(...places);
    } finally {
      for (const place of places) this.module._free(place);
    }
  }

  copy(thing) {
    const bytes =
      typeof thing === 'string' ? new TextEncoder().encode(`${thing}\0`) : new Uint8Array(thing.buffer, thing.byteOffset, thing.byteLength);
    const place = this.module._malloc(Math.max(bytes.length, 8));
    if (place === 0) throw new Error('the page has no memory left');
    this.module.HEAPU8.set(bytes, place);
    return place;
  }

  text(place) {
    return this.module.UTF8ToString(place);
  }

  doubles(place, count) {
    return new Float64Array(this.module.HEAPU8.buffer, place, count);
  }

  floats(place, count) {
    return new Float32Array(this.module.HEAPU8.buffer, place, count);
  }

  bytes(place, count) {
    return new Uint8Array(this.module.HEAPU8.buffer, place, count);
  }
}

function giveAttributes(engine, file, name) {
  const { module } = engine;
  const attrs = reading(() => file.attrs, `${name}: its attributes cannot be read: the file is damaged`);
  if (attrs.format !== 'palpate-model') throw new Error(`${name}: attribute format is "${attrs.format}", expected "palpate-model"`);
  for (const [key, value] of Object.entries(attrs)) {
    const numbers = [value].flat().map(Number);
    if (typeof value === 'string') engine.with([key, value], (n, text) => module._palpate_text(n, text));
    else engine.with([key, Float64Array.from(numbers)], (n, values) => module._palpate_numbers(n, values, numbers.length));
  }
}

function giveArrays(engine, file, bytes, name) {
  const { module } = engine;
  const datasets = reading(() => [...datasetsOf(file)], `${name}: its list of datasets cannot be read: the file is damaged`);
  let total = 0;
  for (const dataset of datasets) {
    checkPlace(name, dataset, total, bytes.byteLength);
    total += dataset.bytes;
    const { path, type, shape } = dataset;
    const place = engine.with([path, Float64Array.from(shape)], (n, lengths) => module._palpate_array(n, type, shape.length, lengths, dataset.bytes));
    if (place === 0) throw new Error(`${name}: /${path}: the page has no memory left`);
    if (dataset.bytes > 0) module.HEAPU8.set(new Uint8Array(bytes, dataset.at, dataset.bytes), place);
  }
}

/** Reads a model's bytes into the engine. @returns its certificate @throws Error  file, what is wrong */
function give(engine, hdf5, bytes, name) {
  const file = opened(hdf5, bytes, name);
  giveAttributes(engine, file, name);
  giveArrays(engine, file, bytes, name);
  return file.attrs.certificate ?? '';
}

/** What core wants hashed lies in its memory, or is short and copied: all of it in one piece. */
function joined(module, parts) {
  const out = new Uint8Array(parts.reduce((sum, { size }) => sum + size, 0));
  let at = 0;
  for (const { place, size, copy } of parts) {
    out.set(copy ?? module.HEAPU8.subarray(place, place + size), at);
    at += size;
  }
  return out;
}

/** The digests that palpate_read() asks for, computed by the page. */
async function digestsOf(module, sha256) {
  const digests = [];
  for (const parts of module.digested) digests.push(...(await sha256(joined(module, parts))));
  return Uint8Array.from(digests);
}

/**
 * Makes an organ of a model file.
 * @param makeModule  what build/wasm/palpate_core.mjs exports
 * @param settings    for it: sha256(bytes) gives 32 bytes, or a promise of them; locateFile, wasmBinary as emscripten has them
 * @param hdf5        the module jsfive
 * @param bytes       the file, an ArrayBuffer
 * @param name        how it is called in messages  @param tipRadius  m
 * @throws Error  one sentence: file, dataset, found, expected
 */
export async function makeOrgan(makeModule, settings, hdf5, bytes, name, tipRadius = 0.005) {
  const engine = new Engine(await makeModule({ ...settings, digested: [] }));
  const { module } = engine;
  const must = (place) => {
    const wrong = engine.text(place);
    if (wrong !== '') throw new Error(wrong);
  };
  engine.with([name], (n) => module._palpate_begin(n));
  const certificate = give(engine, hdf5, bytes, name);
  must(engine.with([name], (n) => module._palpate_read(n)));
  const digests = await digestsOf(module, settings.sha256);
  must(engine.with([name, digests], (n, place) => module._palpate_load(n, place, tipRadius)));
  return new Organ(engine, certificate);
}

/** One model that is felt. Arrays that it gives are views of the engine's memory: valid until the next call. */
export class Organ {
  constructor(engine, certificate) {
    this.engine = engine;
    this.module = engine.module;
    this.certificate = certificate;
    this.nodes = this.module._palpate_nodes();
    this.room = this.module._malloc(8 * 32);
    this.inputBytes = this.module._palpate_input_bytes();
    this.resultBytes = this.module._palpate_result_bytes();
  }

  get id() {
    return this.engine.text(this.module._palpate_id());
  }

  place(barycentric, d) {
    this.engine.doubles(this.room, 6).set([...barycentric, ...d]);
  }

  /** @returns 18 numbers: force, stiffness (row-major), displacement, parameter */
  respond(triangle, barycentric, d) {
    this.place(barycentric, d);
    const status = this.module._palpate_respond(triangle, this.room, this.room + 24, this.room + 48);
    return { status, values: this.engine.doubles(this.room + 48, 18) };
  }

  /** @returns displacement of the surface's nodes, x y z each, m */
  field(triangle, barycentric, d) {
    this.place(barycentric, d);
    return this.engine.floats(this.module._palpate_field(triangle, this.room, this.room + 24), 3 * this.nodes);
  }

  /** StepInput of the next tick, StepResult of the last: bytes as core/tick/step_io.h lays them out. */
  get input() {
    return this.engine.bytes(this.module._palpate_input(), this.inputBytes);
  }
  get result() {
    return this.engine.bytes(this.module._palpate_result(), this.resultBytes);
  }

  step() {
    return this.module._palpate_step();
  }

  /** @returns displacement of the surface's nodes, or undefined where it is the one of before */
  surface() {
    const place = this.module._palpate_surface();
    return place === 0 ? undefined : this.engine.floats(place, 3 * this.nodes);
  }

  /** The rest surface: positions in m, as PROTOCOL.md's MESH has it. */
  mesh() {
    const { engine, module } = this;
    const nodes = this.nodes;
    const count = module._palpate_regions();
    return {
      nodes,
      positions: Float32Array.from(engine.doubles(module._palpate_positions(), 3 * nodes)),
      triangles: this.whole(module._palpate_triangles(), 3 * module._palpate_triangle_count()),
      accessible: engine.bytes(module._palpate_accessible(), nodes).slice(),
      clamped: engine.bytes(module._palpate_clamped(), nodes).slice(),
      regions: Array.from({ length: count }, (_, r) => ({
        name: engine.text(module._palpate_region_name(r)),
        youngs_modulus: module._palpate_region_modulus(r),
        nodes: module._palpate_region_nodes(r),
        positions: Float32Array.from(engine.doubles(module._palpate_region_positions(r), 3 * module._palpate_region_nodes(r))),
        triangles: this.whole(module._palpate_region_triangles(r), 3 * module._palpate_region_triangle_count(r)),
      })),
    };
  }

  whole(place, count) {
    return new Uint32Array(this.module.HEAPU8.buffer, place, count).slice();
  }

  /** E of the model and as asked for, Pa; friction; force limit, N. */
  get parameters() {
    const { module } = this;
    return {
      modelModulus: module._palpate_model_modulus(),
      modulus: module._palpate_modulus(),
      friction: module._palpate_friction(),
      forceLimit: module._palpate_force_limit(),
    };
  }

  /** @returns empty, or which value is out of its range */
  set(modulus, friction) {
    return this.engine.text(this.module._palpate_set(modulus, friction));
  }

  /** The page's tool is taken, or taken back while it lifts off. */
  grab(nowMs) {
    this.module._palpate_grab(nowMs);
  }

  /** The taken tool's goal, m. */
  target([x, y, z], nowMs) {
    this.module._palpate_target(x, y, z, nowMs);
  }

  release() {
    this.module._palpate_release();
  }

  /** A tick with the page's tool. @returns 0 there is none, 1 it has no place yet, 2 there is one */
  tick(nowMs) {
    return this.module._palpate_tick(nowMs);
  }

  /** -n.K n of that tool, N/m, along the rest surface's outward normal n; 0 when free. */
  get stiffness() {
    return this.module._palpate_stiffness();
  }

  /** The driven tool, after a tick: numbers of StepInput and StepResult (core/tick/step_io.h). */
  tool() {
    const input = new DataView(this.module.HEAPU8.buffer, this.module._palpate_input(), this.inputBytes);
    const result = new DataView(this.module.HEAPU8.buffer, this.module._palpate_result(), this.resultBytes);
    const doubles = (view, at, count) => Array.from({ length: count }, (_, i) => view.getFloat64(at + 8 * i, true));
    return {
      tip: doubles(input, 8, 3),
      flags: result.getUint32(0, true),
      state: result.getUint32(4, true),
      force: doubles(result, 8, 3),
      anchor: doubles(result, 104, 3),
      proxy: doubles(result, 128, 3),
      domainRadius: result.getFloat64(176, true),
      penetration: result.getFloat64(184, true),
    };
  }
}
