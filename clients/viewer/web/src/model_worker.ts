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

interface Fetched {
  readonly status: number; // of HTTP; 0: none
  readonly blob?: Blob | undefined;
}

/** Of the page's own web server, with a word on the way. */
function fetchedHere(address: string): Promise<Fetched> {
  const request = new XMLHttpRequest();
  request.open('GET', address);
  request.responseType = 'blob'; // which the browser joins, so that no pieces lie about here
  request.setRequestHeader('Cache-Control', 'max-age=0'); // as fetch() with `no-cache` asks
  let nextMs = performance.now() + SAY_MS;
  request.onprogress = ({ loaded, total }) => {
    if (performance.now() < nextMs) return;
    nextMs = performance.now() + SAY_MS;
    state('starting', `fetching the model: ${megabytes(loaded)} MB${total > 0 ? ` of ${megabytes(total)}` : ''}`);
  };
  return new Promise((end) => {
    request.onloadend = () => end({ status: request.status, blob: (request.response as Blob | null) ?? undefined });
    request.send();
  });
}

/** Of any web server: others would have to allow that header first. */
async function fetchedThere(address: string): Promise<Fetched> {
  try {
    const answer = await fetch(address, { cache: 'no-cache' });
    return { status: answer.status, blob: await answer.blob() };
  } catch {
    throw new Error(`${address}: its web server does not answer, broke off, or does not let this page read it`);
  }
}

/** The file. @throws Error where the address has none */
async function fetched(address: string): Promise<Given> {
  const here = new URL(address).origin === self.location.origin;
  let got: Fetched = here ? await fetchedHere(address) : { status: 0 };
  if (got.status === 0) got = await fetchedThere(address); // also where a redirection leads to another web server
  if (got.status < 200 || got.status > 299 || !got.blob) throw new Error(`${address}: the web server answers ${got.status}`);
  return { bytes: await got.blob.arrayBuffer(), name: nameIn(address) };
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
  const sinceMs = performance.now();
  const [{ bytes, name }, { makeModule, locateFile }] = await Promise.all([
    typeof source === 'string' ? fetched(source) : { bytes: await source.arrayBuffer(), name: source.name },
    core(),
  ]);
  if (performance.now() - sinceMs > SAY_MS) state('starting', 'reading the model');
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
