// SPDX-License-Identifier: Apache-2.0
import { defineConfig } from 'vite';

// Relative addresses and no inline scripts: palpate-viewer serves the page under a strict content policy.
// `npm run dev` passes /ws on to a running palpate-viewer (or to test/pretend_viewer.mjs) at PALPATE_VIEWER.
export default defineConfig({
  base: './',
  build: {
    outDir: process.env['PALPATE_PAGE_OUT'] ?? 'dist',
    emptyOutDir: true,
    target: 'es2022',
    assetsInlineLimit: 0,
    modulePreload: { polyfill: false },
    chunkSizeWarningLimit: 900,
  },
  server: {
    proxy: { '/ws': { target: process.env['PALPATE_VIEWER'] ?? 'http://127.0.0.1:8080', ws: true, changeOrigin: true } },
  },
});
