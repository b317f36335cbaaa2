// SPDX-License-Identifier: Apache-2.0
// What tests of a page without a viewer share: models in a folder, the built page, palpate-viewer --export.
import { execFileSync } from 'node:child_process';
import { existsSync, mkdtempSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, before } from 'node:test';
import { fileURLToPath } from 'node:url';
import { openBrowser, skipWithoutBrowser } from './browser.mjs';
import { bin } from './processes.mjs';

export const DIST = fileURLToPath(new URL('../../../clients/viewer/web/dist', import.meta.url));
export let scratch, browser;

/** Call once, before the tests: a folder `scratch` and a browser, gone after them. @param open  opens another browser */
export function aloneStage(open = openBrowser) {
  skipWithoutBrowser();
  if (!existsSync(join(DIST, 'core/palpate_core.wasm'))) {
    console.log('SKIPPED: core is not built as WebAssembly: tools/install_packages installs emscripten');
    process.exit(0);
  }
  before(async () => {
    scratch = mkdtempSync(join(tmpdir(), 'palpate-alone-'));
    browser = await open();
  });
  after(async () => {
    await browser?.close();
    rmSync(scratch, { recursive: true, force: true });
  });
}

/** The tests' round organ with a nodule. @param subdivisions  3: 642 nodes */
export function organ(name, subdivisions = 3) {
  const file = join(scratch, name);
  execFileSync(join(process.env.PALPATE_TEST_BIN, 'write_round_organ'), [file, String(subdivisions), '0.3']);
  return file;
}

/** The folder that palpate-viewer wrote. */
export function exported(name, model) {
  const folder = join(scratch, name);
  execFileSync(bin('palpate-viewer'), ['--page', DIST, '--export', folder, ...(model ? ['--model', model] : [])]);
  return folder;
}

/** Drops a file of the web server onto the page, as a hand does. */
export async function drop(seen, address, name = address) {
  const things = await seen.page.evaluateHandle(
    async ([from, called]) => {
      const bytes = await (await fetch(from)).blob();
      const transfer = new DataTransfer();
      transfer.items.add(new File([bytes], called));
      return transfer;
    },
    [address, name],
  );
  await seen.page.dispatchEvent('#organ', 'dragover', { dataTransfer: things });
  await seen.page.dispatchEvent('#organ', 'drop', { dataTransfer: things });
}

export const state = (seen) => seen.page.locator('#state-text').textContent();

/** Presses in the middle of the picture until there is a force. @return the figures then */
export async function press(seen) {
  const place = await seen.middle();
  await seen.page.mouse.move(place.x, place.y);
  await seen.page.mouse.down();
  const pressed = await seen.until('pressed 4 mm deep', (f) => f.penetration > 0.0038 && f.penetration < 0.005 && f.force > 0.2);
  await seen.page.mouse.up();
  return pressed;
}
