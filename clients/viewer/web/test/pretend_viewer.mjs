// SPDX-License-Identifier: Apache-2.0
// Speaks palpate.viewer.v1 without a server: a bean that gives way under a spring. For work on the page (`npm run dev`
// beside `node test/pretend_viewer.mjs`), not for tests of what people feel.
import { createServer } from 'node:http';
import { readFile } from 'node:fs/promises';
import { extname, join, normalize } from 'node:path';
import { WebSocketServer } from 'ws';

const port = Number(process.argv[2] ?? 8080);
const folder = process.argv[3] ?? new URL('../dist', import.meta.url).pathname;
const TIP = 0.005;
const STIFFNESS = 900; // N/m

function bean(rings = 32, around = 56) {
  const positions = [];
  const triangles = [];
  for (let i = 0; i <= rings; ++i)
    for (let k = 0; k < around; ++k) {
      const [a, b] = [(Math.PI * i) / rings, (2 * Math.PI * k) / around];
      const r = 0.05 * (1 + 0.25 * Math.sin(a) * Math.cos(b - 0.5) + 0.12 * Math.cos(2 * b));
      positions.push(1.8 * r * Math.sin(a) * Math.cos(b), 1.1 * r * Math.sin(a) * Math.sin(b), 0.75 * r * Math.cos(a));
    }
  for (let i = 0; i < rings; ++i)
    for (let k = 0; k < around; ++k) {
      const [p, q] = [i * around + k, i * around + ((k + 1) % around)];
      triangles.push(p, p + around, q, q, p + around, q + around);
    }
  return { positions: Float32Array.from(positions), triangles: Uint32Array.from(triangles) };
}

const organ = bean();
const nodes = organ.positions.length / 3;
const nowUs = () => Number(process.hrtime.bigint()) / 1000;

function meshMessage() {
  const out = Buffer.alloc(20 + 4 * Math.ceil((14 * nodes) / 4) + 4 * organ.triangles.length);
  out.writeUInt32LE(1, 0);
  out.writeUInt32LE(nodes, 4);
  out.writeUInt32LE(organ.triangles.length / 3, 8);
  out.writeUInt32LE(1, 12);
  Buffer.from(organ.positions.buffer).copy(out, 20);
  const access = 20 + 12 * nodes + 4 * organ.triangles.length;
  Buffer.from(organ.triangles.buffer).copy(out, 20 + 12 * nodes);
  out.fill(1, access, access + nodes);
  return out;
}

function nearest(p) {
  let [best, least] = [0, Infinity];
  for (let n = 0; n < nodes; ++n) {
    const d = Math.hypot(...[0, 1, 2].map((k) => organ.positions[3 * n + k] - p[k]));
    if (d < least) [best, least] = [n, d];
  }
  return { X: [0, 1, 2].map((k) => organ.positions[3 * best + k]), distance: least };
}

/** What a tip at p does: the displacement of the touched point and the spring's force. */
function answer(p) {
  const { X } = nearest(p);
  const n = X.map((x) => x / Math.hypot(...X));
  const above = [0, 1, 2].reduce((sum, k) => sum + (p[k] - X[k]) * n[k], 0) - TIP;
  const depth = Math.max(0, -above);
  return { X, d: n.map((c) => -c * depth), force: n.map((c) => c * depth * STIFFNESS), depth, touching: depth > 0 };
}

function frameMessage(seq, target) {
  const a = target && answer(target);
  const out = Buffer.alloc(56 + 4 * Math.ceil((6 * nodes) / 4) + (a ? 72 + 56 : 0));
  [2, seq, 1, nodes].forEach((x, i) => out.writeUInt32LE(x, 4 * i));
  const now = nowUs();
  out.writeDoubleLE(now - 500, 16);
  out.writeDoubleLE(now, 24);
  out.writeBigUInt64LE(BigInt(seq), 32);
  out.writeUInt32LE(a ? 1 : 0, 40);
  out.writeUInt32LE(a ? 1 : 0, 44);
  const scale = 1e-6;
  out.writeFloatLE(scale, 48);
  if (!a) return out;
  for (let n = 0; n < nodes; ++n) {
    const r = Math.hypot(...[0, 1, 2].map((k) => organ.positions[3 * n + k] - a.X[k]));
    const w = Math.exp(-((r / 0.014) ** 2));
    for (let k = 0; k < 3; ++k) out.writeInt16LE(Math.round((a.d[k] * w) / scale), 56 + 6 * n + 2 * k);
  }
  let at = 56 + 4 * Math.ceil((6 * nodes) / 4);
  [0, a.touching ? 1 : 0, a.touching ? 1 : 0, 1].forEach((x, i) => out.writeUInt32LE(x, at + 4 * i));
  const proxy = a.X.map((x, k) => x + a.d[k]);
  [...target, ...proxy, ...a.X, ...a.force, a.depth, 0.008].forEach((x, i) => out.writeFloatLE(x, at + 16 + 4 * i));
  at += 72;
  out.writeUInt32LE(0, at);
  out.writeUInt32LE(a.touching ? 1 : 0, at + 4);
  out.writeDoubleLE(now, at + 8);
  [Math.hypot(...a.force), a.depth, 20, a.touching ? STIFFNESS : 0, ...a.force, ...target].forEach((x, i) => out.writeFloatLE(x, at + 16 + 4 * i));
  return out;
}

const TYPES = { '.html': 'text/html', '.js': 'text/javascript', '.css': 'text/css', '.svg': 'image/svg+xml' };
const http = createServer(async (request, response) => {
  if (request.url === '/login') return response.end('{"needed":false}');
  const path = normalize(new URL(request.url, 'http://x').pathname);
  const file = join(folder, path === '/' ? 'index.html' : path);
  try {
    response.setHeader('Content-Type', TYPES[extname(file)] ?? 'application/octet-stream');
    response.end(await readFile(file));
  } catch {
    response.writeHead(404).end();
  }
});

new WebSocketServer({ server: http, path: '/ws' }).on('connection', (socket) => {
  const say = (message) => socket.send(JSON.stringify(message));
  let [seq, target, unacknowledged] = [0, undefined, 0];
  say({ type: 'hello', version: 'pretended', protocol: 2, page_id: 1, rate_hz: 60, max_message: 4096 });
  say({ type: 'mesh', revision: 1, model_id: 'bean', nodes, triangles: organ.triangles.length / 3, tip_radius: TIP });
  say({ type: 'state', server: 'serving', text: 'a pretended organ' });
  socket.send(meshMessage());
  const frames = setInterval(() => {
    if (unacknowledged > 2) return;
    ++unacknowledged;
    socket.send(frameMessage(++seq, target));
  }, 16);
  socket.on('message', (data) => {
    const message = JSON.parse(data.toString());
    if (message.type === 'ping') say({ type: 'pong', t0: message.t0, t_us: nowUs() });
    if (message.type === 'ack') unacknowledged = 0;
    if (message.type === 'grab') say({ type: 'tool', granted: true, tool_id: 0, message: '' });
    if (message.type === 'target') target = message.position;
    if (message.type === 'release') target = undefined;
    if (message.type === 'set') say({ type: 'parameters', request: message.request, accepted: true, message: '' });
  });
  socket.on('close', () => clearInterval(frames));
});
http.listen(port, '127.0.0.1', () => console.log(`pretending at http://127.0.0.1:${http.address().port}/`));
