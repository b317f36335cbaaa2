// SPDX-License-Identifier: Apache-2.0
// Any web server: files, and nothing else.
import { createReadStream, existsSync, statSync } from 'node:fs';
import { createServer } from 'node:http';
import { extname, join, normalize } from 'node:path';

const TYPES = {
  '.html': 'text/html', '.mjs': 'text/javascript', '.js': 'text/javascript', '.css': 'text/css', '.json': 'application/json',
  '.wasm': 'application/wasm', '.svg': 'image/svg+xml', '.png': 'image/png', '.webmanifest': 'application/manifest+json',
};

const decoded = (path) => {
  try {
    return decodeURIComponent(path);
  } catch {
    return path;
  }
};

/** Serves the files of some folders, of which the first that has one counts. `close` cuts all its lines. */
export class StaticServer {
  static async open(folders, port = 0) {
    const self = new StaticServer();
    self.asked = []; // paths, in order
    self.first = {}; // by path: statuses and bodies of its first answers, in order
    self.server = createServer((request, response) => self.answer(folders, request, response));
    await new Promise((done) => self.server.listen(port, '127.0.0.1', done));
    self.port = self.server.address().port;
    self.address = `http://127.0.0.1:${self.port}/`;
    return self;
  }

  answer(folders, request, response) {
    const path = normalize(decoded(new URL(request.url, 'http://x').pathname));
    this.asked.push(path);
    const first = this.first[path]?.shift();
    if (first) return response.writeHead(first[0], { 'content-type': 'application/json' }).end(first[1]);
    const files = folders.map((folder) => join(folder, path === '/' ? 'index.html' : path));
    const file = files.find((name) => existsSync(name) && statSync(name).isFile());
    if (!file) return response.writeHead(404).end();
    const { size, mtime } = statSync(file);
    response.writeHead(200, {
      'content-type': TYPES[extname(file)] ?? 'application/octet-stream', 'last-modified': mtime.toUTCString(),
      ...(request.method === 'HEAD' ? {} : { 'content-length': size }), // as servers do that pack what they send
    });
    if (request.method === 'HEAD') return response.end();
    createReadStream(file).pipe(response);
  }

  close() {
    this.server.closeAllConnections();
    return new Promise((done) => this.server.close(done));
  }
}
