// SPDX-License-Identifier: Apache-2.0
import { cpSync, existsSync, readdirSync, readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { defineConfig, type Plugin } from 'vite';

// Relative addresses and no inline scripts: palpate-viewer serves the page under a strict content policy.
// `npm run dev` passes /ws and /login on to a running palpate-viewer (or to test/pretend_viewer.mjs) at PALPATE_VIEWER.
const viewer = process.env['PALPATE_VIEWER'] ?? 'http://127.0.0.1:8080';
const out = process.env['PALPATE_PAGE_OUT'] ?? 'dist';
const core = process.env['PALPATE_CORE']; // folder with core as WebAssembly

const { dependencies } = JSON.parse(readFileSync('package.json', 'utf8')) as { dependencies: Record<string, string> };

// Beside what Vite makes: core, the licences of what is in the page, and files.json, the list of all files but index.html, which pages keep for times without a network.
const completed: Plugin = {
  name: 'palpate-completed',
  closeBundle() {
    for (const file of ['palpate_core.mjs', 'palpate_core.wasm'])
      if (core && existsSync(join(core, file))) cpSync(join(core, file), join(out, 'core', file));
    for (const name of Object.keys(dependencies)) {
      const folder = join('node_modules', name);
      const text = readdirSync(folder).find((file) => /^licen[cs]e/i.test(file));
      if (!text) throw new Error(`${folder} has no licence`);
      cpSync(join(folder, text), join(out, 'licences', `${name.replace('/', '-')}.txt`));
    }
    cpSync('licences', join(out, 'licences'), { recursive: true }); // of what is inside these packages
    const entries = readdirSync(out, { recursive: true, withFileTypes: true }).filter((entry) => entry.isFile());
    const files = entries.map((entry) => join(entry.parentPath ?? entry.path, entry.name).slice(out.length + 1)).sort();
    writeFileSync(join(out, 'files.json'), JSON.stringify(files.filter((file) => file !== 'index.html'), undefined, 1));
  },
};

export default defineConfig({
  base: './',
  plugins: [completed],
  esbuild: { charset: 'ascii' }, // a letter that takes two bytes makes browsers take two for all
  worker: { format: 'es' }, // the model's worker fetches its parts when it needs them
  build: {
    outDir: out,
    emptyOutDir: true,
    target: 'es2022',
    assetsInlineLimit: 0,
    modulePreload: { polyfill: false },
    chunkSizeWarningLimit: 900,
  },
  server: {
    proxy: {
      '/ws': { target: viewer, ws: true, changeOrigin: true },
      '/login': { target: viewer, changeOrigin: true },
    },
  },
});
