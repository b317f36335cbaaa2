// SPDX-License-Identifier: Apache-2.0
// The worker with the line to the viewer.
import { Connection } from './connection';
import { HandOver } from './hand_over';
import type { FromPage, ToPage } from './line';

const tell = (message: ToPage, transfer: Transferable[] = []): void => postMessage(message, { transfer });
const handOver = new HandOver((parcel) => tell({ kind: 'frame', ...parcel }, [parcel.frame.displacement.buffer as ArrayBuffer]));
let connection: Connection | undefined;

onmessage = (event: MessageEvent<FromPage>) => {
  const message = event.data;
  if (message.kind === 'open')
    connection = new Connection(message.source as string, {
      link: (open, text) => {
        handOver.clear();
        tell({ kind: 'link', open, text });
      },
      said: (said) => {
        if (said.type === 'state') handOver.clear();
        tell({ kind: 'said', said });
      },
      mesh: (mesh) => {
        handOver.clear();
        tell({ kind: 'mesh', mesh });
      },
      frame: (frame, received) => handOver.add(frame, received),
      clock: (reading) => tell({ kind: 'clock', reading }),
      trouble: (text) => tell({ kind: 'trouble', text }),
    });
  else if (message.kind === 'say') connection?.send(message.message);
  else if (message.kind === 'hold') connection?.hold(message.position);
  else handOver.taken();
};
