// SPDX-License-Identifier: Apache-2.0
// The worker with the organ itself, in the place of the line to a viewer: core as WebAssembly, a model file, and the ticks.
import * as hdf5 from 'jsfive';
import { makeOrgan } from '../../../../core/wasm/organ.mjs';
import { HandOver } from './hand_over';
import type { FromPage, ToPage } from './line';
import { OrganHost } from './organ_host';

const SAY_MS = 1000; // between words on how far it is: each is drawn, beside what is fetched

const tell = (message: ToPage, transfer: Transferable[] = []): void => postMessage(message, { transfer });
const handOver = new HandOver((parcel) => tell({ kind: 'frame', ...parcel }, [parcel.frame.displacement.buffer as ArrayBuffer]));
let host: OrganHost | undefined;

const state = (server: string, text: string): void => tell({ kind: 'said', said: { type: 'state', server, text, others: '' } });

const megabytes = (bytes: number): string => (bytes / 1e6).toFixed(1);

interface Given {
  readonly bytes: ArrayBuffer;
  readonly name: string;
}

/** The file, with a word on the way; as a blob, of which no pieces lie about. @throws Error where the address has none */
async function fetched(address: string): Promise<Given> {
  const request = new XMLHttpRequest();
  request.open('GET', address);
  request.responseType = 'blob';
  // As fetch() with `no-cache` asks; another web server would have to allow it first.
  if (new URL(address).origin === self.location.origin) request.setRequestHeader('Cache-Control', 'max-age=0');
  let nextMs = performance.now() + SAY_MS;
  request.onprogress = ({ loaded, total }) => {
    if (performance.now() < nextMs) return;
    nextMs = performance.now() + SAY_MS;
    state('starting', `fetching the model: ${megabytes(loaded)} MB${total > 0 ? ` of ${megabytes(total)}` : ''}`);
  };
  await new Promise((end) => {
    request.onloadend = end;
    request.send();
  });
  if (request.status === 0) throw new Error(`${address}: the web server does not answer`);
  if (request.status < 200 || request.status > 299) throw new Error(`${address}: the web server answers ${request.status}`);
  return { bytes: await (request.response as Blob).arrayBuffer(), name: nameIn(address) };
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

/** By the browser; browsers have none for pages that come without https. */
async function digest(bytes: Uint8Array<ArrayBuffer>): Promise<Uint8Array> {
  if (isSecureContext) return new Uint8Array(await crypto.subtle.digest('SHA-256', bytes));
  const { sha256 } = await import('@noble/hashes/sha2.js');
  return sha256(bytes);
}

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
  const [{ bytes, name }, { makeModule, locateFile }] = await Promise.all([
    typeof source === 'string' ? fetched(source) : { bytes: await source.arrayBuffer(), name: source.name },
    core(),
  ]);
  state('starting', 'reading the model');
  const organ = await makeOrgan(makeModule, { sha256: digest, locateFile }, hdf5, bytes, name);
  host = new OrganHost(organ, name, {
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
