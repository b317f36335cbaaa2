// SPDX-License-Identifier: Apache-2.0
import { clockMs, viewerUs, ViewerClock, type ClockReading } from './clock';
import { decodeFrame, decodeMesh, kindOf, KIND_FRAME, KIND_MESH, SUBPROTOCOL, type Frame, type Mesh } from './protocol';
import type { Vec3 } from './vec';

/** What the viewer says as text; fields as in PROTOCOL.md, not trusted to be there. */
export interface Said {
  readonly type: string;
  readonly [field: string]: unknown;
}

/** A frame's way here. */
export interface Received {
  readonly bytes: number;
  readonly delayMs: number; // from the DDS sample at the viewer to the decoded frame; NaN: unknown, or no surface
}

export interface Listener {
  /** The line to the viewer. @param text what to tell people; empty while it stands */
  link(open: boolean, text: string): void;
  said(message: Said): void;
  mesh(mesh: Mesh): void;
  frame(frame: Frame, received: Received): void;
  clock(reading: ClockReading): void;
  trouble(text: string): void;
}

const BAD_MESSAGE = 4000; // close codes from 4000 on are the application's
const FIRST_WAIT_MS = 250;
const LONGEST_WAIT_MS = 3000;
const PING_MS = 500;
const TARGET_MS = 12; // between targets; the viewer makes 1 kHz of them
const HOLD_MS = 1000; // so long a target is repeated for a page that does not come round to a new one

/**
 * The WebSocket to palpate-viewer: opened again when it breaks, each frame acknowledged when it is decoded, the target
 * repeated while the tool is held. Runs in a worker, so that none of this waits for drawing.
 */
export class Connection {
  private readonly clock = new ViewerClock();
  private socket: WebSocket | undefined;
  private waitMs = FIRST_WAIT_MS;
  private held: { position: Vec3; sinceMs: number } | undefined;
  private seq = 0;

  constructor(
    private readonly address: string,
    private readonly listener: Listener,
  ) {
    this.open();
    setInterval(() => this.send({ type: 'ping', t0: clockMs() }), PING_MS);
    setInterval(() => this.repeat(), TARGET_MS);
  }

  send(message: object): void {
    if (this.socket?.readyState === WebSocket.OPEN) this.socket.send(JSON.stringify(message));
  }

  /** Where the tool is to be until the next call; undefined: no tool is held. */
  hold(position: Vec3 | undefined): void {
    this.held = position && { position, sinceMs: clockMs() };
  }

  private repeat(): void {
    if (this.held && clockMs() - this.held.sinceMs < HOLD_MS)
      this.send({ type: 'target', position: this.held.position, seq: ++this.seq });
  }

  private open(): void {
    const socket = new WebSocket(this.address, SUBPROTOCOL);
    socket.binaryType = 'arraybuffer';
    this.socket = socket;
    socket.onopen = () => {
      this.waitMs = FIRST_WAIT_MS;
      this.clock.forget();
      this.send({ type: 'ping', t0: clockMs() });
      this.listener.link(true, '');
    };
    socket.onmessage = (event: MessageEvent<ArrayBuffer | string>) => {
      if (socket.readyState === WebSocket.OPEN) this.heard(event.data); // not what came after it was given up
    };
    socket.onclose = (event) => {
      this.held = undefined;
      this.listener.link(false, event.reason || 'no line to palpate-viewer');
      setTimeout(() => this.open(), this.waitMs);
      this.waitMs = Math.min(LONGEST_WAIT_MS, 2 * this.waitMs);
    };
  }

  private heard(data: ArrayBuffer | string): void {
    try {
      if (typeof data === 'string') this.text(JSON.parse(data) as Said);
      else this.binary(data);
    } catch (error) {
      this.listener.trouble(error instanceof Error ? error.message : String(error));
      this.giveUp();
    }
  }

  /** What cannot be decoded is never acknowledged, and two such frames are the last that come: begins anew, not at once. */
  private giveUp(): void {
    this.waitMs = LONGEST_WAIT_MS;
    this.socket?.close(BAD_MESSAGE, 'palpate-viewer sent a bad message');
  }

  private text(message: Said): void {
    if (message.type !== 'pong') return this.listener.said(message);
    this.clock.learn(Number(message['t0']), clockMs(), Number(message['t_us']));
    this.listener.clock(this.clock.reading());
  }

  private binary(data: ArrayBuffer): void {
    const kind = kindOf(data);
    if (kind === KIND_MESH) this.listener.mesh(decodeMesh(data));
    if (kind !== KIND_FRAME) return;
    const frame = decodeFrame(data);
    const nowUs = viewerUs(this.clock.reading(), clockMs());
    this.send({ type: 'ack', seq: frame.seq });
    const delayMs = frame.nodes === 0 ? NaN : (nowUs - frame.sampleUs) / 1000;
    this.listener.frame(frame, { bytes: data.byteLength, delayMs });
  }
}

/** Where the viewer of this page listens; a token in the page's address goes along. */
export function viewerAddress(page: { protocol: string; host: string; pathname: string; search: string }): string {
  const token = new URLSearchParams(page.search).get('token');
  const scheme = page.protocol === 'https:' ? 'wss:' : 'ws:';
  const folder = page.pathname.replace(/[^/]*$/, '');
  return `${scheme}//${page.host}${folder}ws${token === null ? '' : `?token=${encodeURIComponent(token)}`}`;
}
