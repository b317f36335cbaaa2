// SPDX-License-Identifier: Apache-2.0
import assert from 'node:assert/strict';
import { mock, test } from 'node:test';
import { Connection } from '../src/connection';

/** A browser's WebSocket whose other end is the test. */
class Line {
  static readonly OPEN = 1;
  static readonly all: Line[] = [];
  readyState = 0;
  sent: string[] = [];
  closedWith: number | undefined;
  onopen?: () => void;
  onmessage?: (event: { data: unknown }) => void;
  onclose?: (event: { reason: string }) => void;

  constructor() {
    Line.all.push(this);
  }

  send(text: string): void {
    this.sent.push(text);
  }

  close(code: number): void {
    this.readyState = 2;
    this.closedWith = code;
  }

  opened(): void {
    this.readyState = Line.OPEN;
    this.onopen?.();
  }

  ended(): void {
    this.readyState = 3;
    this.onclose?.({ reason: '' });
  }
}

/** A frame without a surface, tools or answers. */
function emptyFrame(seq: number): ArrayBuffer {
  const data = new ArrayBuffer(56);
  new Uint32Array(data).set([2, seq, 1, 0]);
  return data;
}

test('a frame that cannot be read ends the line, and it is opened again', () => {
  mock.timers.enable({ apis: ['setInterval', 'setTimeout'] });
  Object.assign(globalThis, { WebSocket: Line });
  const [frames, troubles]: [number[], string[]] = [[], []];
  const none = (): void => {};
  new Connection('ws://nowhere', {
    link: none, said: none, mesh: none, clock: none, frame: (frame) => frames.push(frame.seq), trouble: (text) => troubles.push(text),
  });
  const [first] = Line.all;
  first.opened();
  first.onmessage?.({ data: emptyFrame(1) });
  assert.ok(first.sent.some((text) => text === '{"type":"ack","seq":1}'), first.sent.join());
  first.onmessage?.({ data: emptyFrame(2).slice(0, 52) });
  assert.equal(first.closedWith, 4000);
  assert.match(troubles.join(), /52 bytes/);
  first.onmessage?.({ data: emptyFrame(3) }); // was on its way
  first.ended();
  mock.timers.tick(500);
  assert.equal(Line.all.length, 1, 'a viewer that sends garbage is not asked again at once');
  mock.timers.tick(5000);
  assert.equal(Line.all.length, 2);
  Line.all[1].opened();
  Line.all[1].onmessage?.({ data: emptyFrame(4) });
  assert.deepEqual(frames, [1, 4]);
  mock.timers.reset();
});
