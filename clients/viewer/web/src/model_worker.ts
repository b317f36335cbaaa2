// SPDX-License-Identifier: Apache-2.0
// The worker with the organ itself, in the place of the line to a viewer: core as WebAssembly, a model file, and the ticks.
import { sha256 } from '@noble/hashes/sha2.js';
import { makeOrgan } from '../../../../core/wasm/organ.mjs';
import { HandOver } from './hand_over';
import type { FromPage, ToPage } from './line';
import { OrganHost } from './organ_host';

const FOLDER = '/given';
const FILE = 'model'; // there, whatever it is called outside
const SAY_MS = 250; // between words on how far it is

const tell = (message: ToPage, transfer: Transferable[] = []): void => postMessage(message, { transfer });
const handOver = new HandOver((parcel) => tell({ kind: 'frame', ...parcel }, [parcel.frame.displacement.buffer as ArrayBuffer]));
let host: OrganHost | undefined;

const state = (server: string, text: string): void => tell({ kind: 'said', said: { type: 'state', server, text, others: '' } });

const megabytes = (bytes: number): string => (bytes / 1e6).toFixed(1);

/** The file, with a word on the way. @throws Error where the address has none */
async function fetched(address: string): Promise<File> {
  const answer = await fetch(address, { cache: 'no-cache' });
  if (!answer.ok || !answer.body) throw new Error(`${address}: the web server answers ${answer.status}`);
  const packed = answer.headers.has('content-encoding'); // then the length is that of what is sent
  const size = packed ? 0 : Number(answer.headers.get('content-length')) || 0;
  let [got, nextMs] = [0, 0];
  const counted = new TransformStream<Uint8Array, Uint8Array>({
    transform(part, out) {
      got += part.length;
      out.enqueue(part);
      if (performance.now() < nextMs) return;
      nextMs = performance.now() + SAY_MS;
      state('starting', `fetching the model: ${megabytes(got)} MB${size > 0 ? ` of ${megabytes(size)}` : ''}`);
    },
  });
  const bytes = await new Response(answer.body.pipeThrough(counted)).blob(); // the browser's memory or disk, not this worker's
  return new File([bytes], nameIn(address));
}

/** A model's name for people. */
function nameIn(address: string): string {
  const name = new URL(address).pathname.replace(/.*\//, '');
  try {
    return decodeURIComponent(name) || address;
  } catch {
    return name;
  }
}

const digest = (): object => {
  const hash = sha256.create();
  return { add: (part: Uint8Array) => void hash.update(part), finish: () => hash.digest() };
};

/** core, which lies beside the page. @throws Error where it does not */
async function core(): Promise<{ makeModule: unknown; locateFile: (path: string) => string }> {
  const base = new URL('../core/', self.location.href).href;
  const locateFile = (path: string): string => base + path;
  try {
    const { default: makeModule } = (await import(/* @vite-ignore */ locateFile('palpate_core.mjs'))) as { default: unknown };
    return { makeModule, locateFile };
  } catch {
    throw new Error(`${base}palpate_core.mjs is not there: this page was built without emscripten`);
  }
}

async function open(source: string | File): Promise<void> {
  tell({ kind: 'clock', reading: { tripMs: 0, offsetUs: 0 } });
  state('starting', 'fetching the model');
  const [model, { default: h5wasm }, { makeModule, locateFile }] = await Promise.all([
    typeof source === 'string' ? fetched(source) : source,
    import('h5wasm'),
    core(),
  ]);
  state('starting', 'reading the model');
  const hdf5 = await h5wasm.ready;
  hdf5.FS.mkdir(FOLDER);
  hdf5.FS.mount(hdf5.FS.filesystems.WORKERFS, { blobs: [{ name: FILE, data: model }] }, FOLDER); // reads where the file is: no copy of it here
  const file = new h5wasm.File(`${FOLDER}/${FILE}`, 'r');
  if (file.file_id < 0n) throw new Error(`${model.name} is no HDF5 file`);
  const organ = await makeOrgan(makeModule, { sha256: digest, locateFile }, hdf5, file, model.size, model.name);
  host = new OrganHost(organ, model.name, {
    said: (said) => tell({ kind: 'said', said }),
    mesh: (mesh) => tell({ kind: 'mesh', mesh }),
    frame: (frame) => handOver.add(frame, { bytes: 2 * frame.displacement.length, delayMs: 0 }),
  });
  tell({ kind: 'link', open: true, text: '' }); // now it hears what the page asks for
}

onmessage = (event: MessageEvent<FromPage>) => {
  const message = event.data;
  if (message.kind === 'open')
    open(message.source).catch((error: unknown) => {
      state('gone', error instanceof Error ? error.message : String(error));
      self.close(); // with all its memory
    });
  else if (message.kind === 'say') host?.say(message.message as { type: string });
  else if (message.kind === 'hold') host?.hold(message.position, message.goal);
  else handOver.taken();
};
