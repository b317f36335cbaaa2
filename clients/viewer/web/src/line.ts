// SPDX-License-Identifier: Apache-2.0
import { clockMs, viewerUs, type ClockReading } from './clock';
import type { Received, Said } from './connection';
import type { Frame, Mesh } from './protocol';
import type { Vec3 } from './vec';

export type ToPage =
  | { kind: 'link'; open: boolean; text: string }
  | { kind: 'said'; said: Said }
  | { kind: 'mesh'; mesh: Mesh }
  | { kind: 'frame'; frame: Frame; received: readonly Received[] }
  | { kind: 'clock'; reading: ClockReading }
  | { kind: 'trouble'; text: string };

export type FromPage =
  | { kind: 'open'; source: string | File }
  | { kind: 'say'; message: object }
  | { kind: 'hold'; position: Vec3 | undefined; goal: Vec3 | undefined }
  | { kind: 'taken' };

export interface LineListener {
  link(open: boolean, text: string): void;
  said(message: Said): void;
  mesh(mesh: Mesh): void;
  frame(frame: Frame, received: readonly Received[]): void;
  trouble(text: string): void;
}

/** Where the organ is: at a viewer, by its WebSocket's address, or in a model file, by its address or itself. */
export type Source = { readonly viewer: string } | { readonly model: string | File };

/** The page's end of the worker that talks to the viewer, or that has the organ itself. */
export class Line {
  private reading: ClockReading = { tripMs: NaN, offsetUs: NaN };
  private worker: Worker | undefined; // none until open()

  constructor(private readonly listener: LineListener) {}

  /** Ends what was open before, with all its memory. */
  open(source: Source): void {
    if (this.worker) {
      this.worker.onmessage = null; // what it sent last is still on its way
      this.worker.terminate();
    }
    this.worker =
      'viewer' in source
        ? new Worker(new URL('./line_worker.ts', import.meta.url), { type: 'module' })
        : new Worker(new URL('./model_worker.ts', import.meta.url), { type: 'module' });
    this.worker.onmessage = (event: MessageEvent<ToPage>) => this.heard(event.data);
    this.worker.onerror = (event) => this.listener.trouble(event.message || 'the page\'s worker did not start');
    this.tell({ kind: 'open', source: 'viewer' in source ? source.viewer : source.model });
  }

  get isOpen(): boolean {
    return this.worker !== undefined;
  }

  send(message: object): void {
    this.tell({ kind: 'say', message });
  }

  /** The target of this page's tool; undefined when it holds none. @param goal  to where it goes on by itself */
  hold(position: Vec3 | undefined, goal = position): void {
    this.tell({ kind: 'hold', position, goal });
  }

  /** Shortest round trip to the viewer, ms. */
  get tripMs(): number {
    return this.reading.tripMs;
  }

  /** The viewer's clock, us; NaN until it is known. */
  get nowUs(): number {
    return viewerUs(this.reading, clockMs());
  }

  private tell(message: FromPage): void {
    this.worker?.postMessage(message);
  }

  private heard(message: ToPage): void {
    if (message.kind === 'link') this.listener.link(message.open, message.text);
    else if (message.kind === 'said') this.listener.said(message.said);
    else if (message.kind === 'mesh') this.listener.mesh(message.mesh);
    else if (message.kind === 'clock') this.reading = message.reading;
    else if (message.kind === 'trouble') this.listener.trouble(message.text);
    else {
      this.listener.frame(message.frame, message.received);
      this.tell({ kind: 'taken' });
    }
  }
}
