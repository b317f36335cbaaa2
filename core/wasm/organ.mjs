// SPDX-License-Identifier: Apache-2.0
// An organ in a page or in node: core as WebAssembly, with a model file that h5wasm has opened.
const TYPES = { '<d': 0, '<f': 1, '<h': 2, '<i': 3, '<q': 4, '<B': 5, '<b': 7 };
const OTHER = 6; // of a region's name, text of a fixed length; core refuses what is neither
const MOST_AT_ONCE = 4e6; // bytes that h5wasm holds beside the file and core

const bytesOf = ({ metadata, shape }) => metadata.size * (shape ?? []).reduce((product, length) => product * length, shape ? 1 : 0);

/** Calls visit(bytes, at) with a dataset's bytes as the file has them, some rows at a time: views of h5wasm's memory. */
function forEachPart(hdf5, dataset, visit) {
  const [rows = 1, ...others] = dataset.shape ?? [0];
  const row = rows > 0 ? bytesOf(dataset) / rows : 0;
  if (row === 0) return;
  const most = Math.min(rows, Math.max(1, Math.floor(MOST_AT_ONCE / row)));
  const place = hdf5._malloc(most * row);
  if (place === 0) throw new Error(`${dataset.path}: the page has no memory left`);
  try {
    for (let first = 0; first < rows; first += most) {
      const count = Math.min(most, rows - first);
      const slab = dataset.shape.length === 0 ? [null, null, null] : slabOf(first, count, others);
      hdf5.get_dataset_data(dataset.file_id, dataset.path, ...slab, BigInt(place));
      visit(hdf5.HEAPU8.subarray(place, place + count * row), first * row);
    }
  } finally {
    hdf5._free(place);
  }
}

/** Rows of an array as HDF5 names them: counts, offsets, strides. */
const slabOf = (first, count, others) => [
  [count, ...others].map(BigInt),
  [first, ...others.map(() => 0)].map(BigInt),
  [1, ...others.map(() => 1)].map(BigInt),
];

/** Calls visit(path, dataset) for what lies where a model's datasets lie: in a group of the file, "contact/force". */
function forEachDataset(file, visit) {
  for (const key of file.keys()) {
    const group = file.get(key);
    if (group?.type !== 'Group') continue;
    for (const name of group.keys()) {
      const thing = group.get(name);
      if (thing?.type === 'Dataset') visit(`${key}/${name}`, thing);
    }
  }
}

/**
 * Refuses what would take more memory than its file has bytes, before any is taken. Numbers count as they are stored.
 * @param size  of the file  @param before  bytes of the datasets before  @throws Error  file, dataset, found, expected
 */
function checkSize(name, path, { metadata }, bytes, before, size) {
  const fail = (what) => {
    throw new Error(`${name}: /${path} ${what}`);
  };
  if (!(bytes <= size)) fail(`has ${bytes} bytes, more than the file's ${size} can hold`);
  if (!(before + bytes <= size)) fail(`brings the datasets to ${before + bytes} bytes, more than the file's ${size} can hold`);
  if (metadata.chunks) fail('is chunked, expected contiguous');
  if (metadata.vlen) fail('has parts of any length, expected numbers or names of 64 bytes');
}

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

function giveAttributes(engine, file) {
  const { module } = engine;
  for (const [name, { value, metadata }] of Object.entries(file.attrs)) {
    const whole = metadata.type === 0; // H5T_INTEGER
    const fits = !ArrayBuffer.isView(value) && Number(value) === (Number(value) | 0);
    if (typeof value === 'string') engine.with([name, value], (n, text) => module._palpate_text(n, text));
    else if (whole && fits) engine.with([name], (n) => module._palpate_integer(n, Number(value)));
    else if (whole) engine.with([name, 'whole numbers'], (n, text) => module._palpate_text(n, text)); // none that a model has
    else {
      const numbers = Float64Array.from(ArrayBuffer.isView(value) ? value : [value], Number);
      engine.with([name, numbers], (n, values) => module._palpate_numbers(n, values, numbers.length));
    }
  }
}

function giveArrays(engine, hdf5, file, size, name) {
  const { module } = engine;
  let total = 0;
  forEachDataset(file, (path, dataset) => {
    const bytes = bytesOf(dataset);
    checkSize(name, path, dataset, bytes, total, size);
    total += bytes;
    const type = TYPES[dataset.dtype] ?? OTHER;
    const shape = Float64Array.from(dataset.shape ?? [], Number);
    const place = engine.with([path, shape], (place, lengths) => module._palpate_array(place, type, shape.length, lengths, bytes));
    if (place === 0) throw new Error(`${path}: the page has no memory left`);
    forEachPart(hdf5, dataset, (part, at) => module.HEAPU8.set(part, place + at));
  });
}

/**
 * Makes an organ of a model file.
 * @param makeModule  what build/wasm/palpate_core.mjs exports
 * @param settings    for it: sha256() gives an object with add(bytes) and finish(); locateFile, wasmBinary as emscripten has them
 * @param hdf5        what h5wasm.ready gives  @param file  h5wasm's File, open; it is closed
 * @param size  bytes of the file: datasets that claim more are refused
 * @param name        how it is called in messages  @param tipRadius  m
 * @throws Error  one sentence: file, dataset, found, expected
 */
export async function makeOrgan(makeModule, settings, hdf5, file, size, name, tipRadius = 0.005) {
  const engine = new Engine(await makeModule({ ...settings }));
  engine.with([name], (n) => engine.module._palpate_begin(n));
  try {
    giveAttributes(engine, file);
    giveArrays(engine, hdf5, file, size, name);
  } finally {
    file.close();
  }
  const wrong = engine.with([name], (n) => engine.text(engine.module._palpate_load(n, tipRadius)));
  if (wrong !== '') throw new Error(wrong);
  return new Organ(engine);
}

/** One model that is felt. Arrays that it gives are views of the engine's memory: valid until the next call. */
export class Organ {
  constructor(engine) {
    this.engine = engine;
    this.module = engine.module;
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
