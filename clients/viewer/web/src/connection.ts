// SPDX-License-Identifier: Apache-2.0
import { clockMs, viewerUs, ViewerClock, type ClockReading } from './clock';
import { decodeFrame, decodeMesh, kindOf, KIND_FRAME, KIND_MESH, SUBPROTOCOL, type Frame, type Mesh } from './protocol';
import type { Vec3 } from './vec';

/** A text message of the viewer; fields as in PROTOCOL.md, any of which may be missing. */
export interface Said {
  readonly type: string;
  readonly [field: string]: unknown;
}

/** How a frame came here. */
export interface Received {
  readonly bytes: number;
  readonly delayMs: number; // from the DDS sample at the viewer to the decoded frame; NaN: unknown, or no surface
}

export interface Listener {
  /** The line to the viewer. @param text for people; empty while the line is up */
  link(open: boolean, text: string): void;
  said(message: Said): void;
  mesh(mesh: Mesh): void;
  frame(frame: Frame, received: Received): void;
  clock(reading: ClockReading): void;
  trouble(text: string): void;
}

const BAD_MESSAGE = 4000; // applications use close codes from 4000 on
const FIRST_WAIT_MS = 250;
const LONGEST_WAIT_MS = 3000;
const PING_MS = 500;
const TARGET_MS = 12; // between targets; the viewer turns them into 1 kHz
const HOLD_MS = 1000; // longest repetition of a target while a busy page sends no new one

/**
 * The WebSocket to palpate-viewer. It opens again when it breaks, acknowledges each frame once it is decoded, and repeats
 * the target while the tool is held. It runs in a worker, so that none of this waits for drawing.
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

  /** The tool's target until the next call; undefined: no tool is held. */
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
      if (socket.readyState === WebSocket.OPEN) this.heard(event.data); // ignores what comes after close()
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

  /** A message that cannot be decoded is not acknowledged, and after two such frames none comes: closes, to reconnect later. */
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

/** The WebSocket's address at this page's viewer. */
export function viewerAddress(page: { protocol: string; host: string; pathname: string }): string {
  const scheme = page.protocol === 'https:' ? 'wss:' : 'ws:';
  return `${scheme}//${page.host}${page.pathname.replace(/[^/]*$/, '')}ws`;
}
