// SPDX-License-Identifier: Apache-2.0
// The worker with the organ itself, in the place of the line to a viewer: core as WebAssembly, a model file, and the ticks.
import { makeOrgan } from '../../../../core/wasm/organ.mjs';
import { HandOver } from './hand_over';
import type { FromPage, ToPage } from './line';
import { OrganHost } from './organ_host';

const tell = (message: ToPage, transfer: Transferable[] = []): void => postMessage(message, { transfer });
const handOver = new HandOver((parcel) => tell({ kind: 'frame', ...parcel }, [parcel.frame.displacement.buffer as ArrayBuffer]));
let host: OrganHost | undefined;

const state = (server: string, text: string): void => tell({ kind: 'said', said: { type: 'state', server, text, others: '' } });

/** The file's bytes, with a word on the way. @throws Error where the address has none */
async function fetched(address: string): Promise<Uint8Array> {
  const answer = await fetch(address);
  if (!answer.ok || !answer.body) throw new Error(`${address}: the web server answers ${answer.status}`);
  const size = Number(answer.headers.get('content-length')) || 0;
  const parts: Uint8Array[] = [];
  let got = 0;
  const reader = answer.body.getReader();
  for (let part = await reader.read(); !part.done; part = await reader.read()) {
    parts.push(part.value);
    got += part.value.length;
    state('starting', `fetching the model: ${(got / 1e6).toFixed(1)} MB${size > 0 ? ` of ${(size / 1e6).toFixed(1)}` : ''}`);
  }
  const bytes = new Uint8Array(got);
  let at = 0;
  for (const part of parts) {
    bytes.set(part, at);
    at += part.length;
  }
  return bytes;
}

async function open(address: string): Promise<void> {
  tell({ kind: 'link', open: true, text: '' });
  tell({ kind: 'clock', reading: { tripMs: 0, offsetUs: 0 } });
  state('starting', 'fetching the model');
  const name = address.replace(/.*\//, '');
  const bytes = await fetched(address);
  state('starting', 'reading the model');
  const base = new URL('../core/', self.location.href).href;
  const [{ default: h5wasm }, { sha256 }, { default: makeModule }] = await Promise.all([
    import('h5wasm'),
    import('@noble/hashes/sha2.js'),
    import(/* @vite-ignore */ `${base}palpate_core.mjs`) as Promise<{ default: unknown }>,
  ]);
  const hdf5 = await h5wasm.ready;
  hdf5.FS.writeFile(name, bytes, { canOwn: true } as { flags?: string }); // no second copy
  const file = new h5wasm.File(name, 'r');
  hdf5.FS.unlink(name); // the open file keeps it
  const digest = (): object => {
    const hash = sha256.create();
    return { add: (part: Uint8Array) => void hash.update(part), finish: () => hash.digest() };
  };
  const organ = await makeOrgan(makeModule, { sha256: digest, locateFile: (path: string) => base + path }, hdf5, file, name);
  host = new OrganHost(organ, name, {
    said: (said) => tell({ kind: 'said', said }),
    mesh: (mesh) => tell({ kind: 'mesh', mesh }),
    frame: (frame) => handOver.add(frame, { bytes: 2 * frame.displacement.length, delayMs: 0 }),
  });
}

onmessage = (event: MessageEvent<FromPage>) => {
  const message = event.data;
  if (message.kind === 'open')
    open(message.address).catch((error: unknown) => state('gone', error instanceof Error ? error.message : String(error)));
  else if (message.kind === 'say') host?.say(message.message as { type: string });
  else if (message.kind === 'hold') host?.hold(message.position);
  else {
    handOver.taken();
    host?.taken();
  }
};
