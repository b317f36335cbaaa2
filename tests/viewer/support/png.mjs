// SPDX-License-Identifier: Apache-2.0
// Reads the PNG that chromium writes: 8 bits, RGB or RGBA, not interlaced (ISO/IEC 15948).
import { inflateSync } from 'node:zlib';

/** @return {width, height, at(x, y)} with at giving [r, g, b] */
export function decodePng(data) {
  let [at, head] = [8, undefined];
  const packed = [];
  while (at < data.length) {
    const length = data.readUInt32BE(at);
    const kind = data.toString('latin1', at + 4, at + 8);
    const content = data.subarray(at + 8, at + 8 + length);
    if (kind === 'IHDR') head = { width: content.readUInt32BE(0), height: content.readUInt32BE(4), depth: content[8], colour: content[9], interlace: content[12] };
    if (kind === 'IDAT') packed.push(content);
    at += 12 + length;
  }
  if (!head || head.depth !== 8 || ![2, 6].includes(head.colour) || head.interlace) throw new Error(`a PNG of another kind: ${JSON.stringify(head)}`);
  const channels = head.colour === 6 ? 4 : 3;
  const pixels = unfilter(inflateSync(Buffer.concat(packed)), head.width * channels, head.height, channels);
  const { width, height } = head;
  return { width, height, at: (x, y) => [0, 1, 2].map((k) => pixels[(y * width + x) * channels + k]) };
}

function unfilter(raw, row, height, channels) {
  const out = Buffer.alloc(row * height);
  for (let y = 0; y < height; ++y) {
    const filter = raw[y * (row + 1)];
    for (let i = 0; i < row; ++i) {
      const left = i >= channels ? out[y * row + i - channels] : 0;
      const up = y > 0 ? out[(y - 1) * row + i] : 0;
      const corner = y > 0 && i >= channels ? out[(y - 1) * row + i - channels] : 0;
      out[y * row + i] = raw[y * (row + 1) + 1 + i] + predicted(filter, left, up, corner);
    }
  }
  return out;
}

function predicted(filter, left, up, corner) {
  if (filter === 1) return left;
  if (filter === 2) return up;
  if (filter === 3) return (left + up) >> 1;
  if (filter !== 4) return 0;
  const guess = left + up - corner;
  const [a, b, c] = [left, up, corner].map((v) => Math.abs(guess - v));
  return a <= b && a <= c ? left : b <= c ? up : corner;
}

/** Share of pixels that differ by more than `least` of 255 in a channel. */
export function shareChanged(a, b, least = 24) {
  let changed = 0;
  for (let y = 0; y < a.height; ++y)
    for (let x = 0; x < a.width; ++x) {
      const [p, q] = [a.at(x, y), b.at(x, y)];
      if (p.some((v, k) => Math.abs(v - q[k]) > least)) ++changed;
    }
  return changed / (a.width * a.height);
}

/** Mean colour, [r, g, b]. */
export function meanOf(picture) {
  const sum = [0, 0, 0];
  for (let y = 0; y < picture.height; ++y)
    for (let x = 0; x < picture.width; ++x) picture.at(x, y).forEach((v, k) => (sum[k] += v));
  return sum.map((v) => v / (picture.width * picture.height));
}
