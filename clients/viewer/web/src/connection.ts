// SPDX-License-Identifier: Apache-2.0
import { ViewerClock } from './clock';
import { decodeFrame, decodeMesh, kindOf, KIND_FRAME, KIND_MESH, SUBPROTOCOL, type Frame, type Mesh } from './protocol';
import type { Vec3 } from './vec';

/** What the viewer says as text; fields as in PROTOCOL.md, not trusted to be there. */
export interface Said {
  readonly type: string;
  readonly [field: string]: unknown;
}

export interface Listener {
  /** The line to the viewer. @param text what to tell people; empty while it stands */
  link(open: boolean, text: string): void;
  said(message: Said): void;
  mesh(mesh: Mesh): void;
  frame(frame: Frame, bytes: number): void;
  trouble(text: string): void;
}

const FIRST_WAIT_MS = 250;
const LONGEST_WAIT_MS = 3000;
const PING_MS = 500;

/** The WebSocket to palpate-viewer: opened again when it breaks, each frame acknowledged when it is decoded. */
export class Connection {
  readonly clock = new ViewerClock();
  private socket: WebSocket | undefined;
  private waitMs = FIRST_WAIT_MS;

  constructor(
    private readonly address: string,
    private readonly listener: Listener,
  ) {
    this.open();
    setInterval(() => this.send({ type: 'ping', t0: performance.now() }), PING_MS);
  }

  get isOpen(): boolean {
    return this.socket?.readyState === WebSocket.OPEN;
  }

  send(message: object): void {
    if (this.isOpen) this.socket?.send(JSON.stringify(message));
  }

  grab(): void {
    this.send({ type: 'grab' });
  }

  release(): void {
    this.send({ type: 'release' });
  }

  target(position: Vec3, seq: number): void {
    this.send({ type: 'target', position, seq });
  }

  private open(): void {
    const socket = new WebSocket(this.address, SUBPROTOCOL);
    socket.binaryType = 'arraybuffer';
    this.socket = socket;
    socket.onopen = () => {
      this.waitMs = FIRST_WAIT_MS;
      this.clock.forget();
      this.send({ type: 'ping', t0: performance.now() });
      this.listener.link(true, '');
    };
    socket.onmessage = (event: MessageEvent<ArrayBuffer | string>) => this.heard(event.data);
    socket.onclose = (event) => {
      this.listener.link(false, event.reason || (event.code === 1013 ? 'the viewer has too many pages' : 'no line to palpate-viewer'));
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
    }
  }

  private text(message: Said): void {
    if (message.type === 'pong') this.clock.learn(Number(message['t0']), performance.now(), Number(message['t_us']));
    else this.listener.said(message);
  }

  private binary(data: ArrayBuffer): void {
    const kind = kindOf(data);
    if (kind === KIND_MESH) this.listener.mesh(decodeMesh(data));
    if (kind !== KIND_FRAME) return;
    const frame = decodeFrame(data);
    this.send({ type: 'ack', seq: frame.seq });
    this.listener.frame(frame, data.byteLength);
  }
}

/** Where the viewer of this page listens; a token in the page's address goes along. */
export function viewerAddress(page: Location): string {
  const token = new URLSearchParams(page.search).get('token');
  const scheme = page.protocol === 'https:' ? 'wss:' : 'ws:';
  const folder = page.pathname.replace(/[^/]*$/, '');
  return `${scheme}//${page.host}${folder}ws${token === null ? '' : `?token=${encodeURIComponent(token)}`}`;
}
