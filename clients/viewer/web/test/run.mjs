// SPDX-License-Identifier: Apache-2.0
// Bundles the tests, which are TypeScript like the page, and runs them with node's own runner.
import { existsSync, mkdtempSync, readdirSync, rmSync } from 'node:fs';
import { spawnSync } from 'node:child_process';
import { dirname, join } from 'node:path';
import { fileURLToPath } from 'node:url';

const here = dirname(fileURLToPath(import.meta.url));
if (!existsSync(join(here, '../node_modules/esbuild'))) {
  console.log('SKIPPED: npm could not fetch the packages that package-lock.json names');
  process.exit(0);
}
const { buildSync } = await import('esbuild');
const out = mkdtempSync(join(here, '../node_modules/.tests-'));
try {
  const entryPoints = readdirSync(here).filter((name) => name.endsWith('.test.ts')).map((name) => join(here, name));
  buildSync({ entryPoints, bundle: true, platform: 'node', format: 'esm', outdir: out, outExtension: { '.js': '.mjs' }, logLevel: 'error' });
  const files = readdirSync(out).map((name) => join(out, name));
  const ran = spawnSync(process.execPath, ['--test', ...files], { stdio: 'inherit', env: { ...process.env, PALPATE_WEB: join(here, '..') } });
  process.exitCode = ran.status ?? 1;
} finally {
  rmSync(out, { recursive: true, force: true });
}
