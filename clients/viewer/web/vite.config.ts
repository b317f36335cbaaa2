// SPDX-License-Identifier: Apache-2.0
import { defineConfig } from 'vite';

// Relative addresses and no inline scripts: palpate-viewer serves the page under a strict content policy.
// `npm run dev` passes /ws and /login on to a running palpate-viewer (or to test/pretend_viewer.mjs) at PALPATE_VIEWER.
const viewer = process.env['PALPATE_VIEWER'] ?? 'http://127.0.0.1:8080';

export default defineConfig({
  base: './',
  worker: { format: 'es' }, // the model's worker fetches its parts when it needs them
  build: {
    outDir: process.env['PALPATE_PAGE_OUT'] ?? 'dist',
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
