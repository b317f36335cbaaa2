// SPDX-License-Identifier: Apache-2.0
// Debian's chromium, headless, drawing in software.
import { existsSync, mkdirSync } from 'node:fs';
import { createRequire } from 'node:module';
import { join } from 'node:path';
import { decodePng } from './png.mjs';

const web = new URL('../../../clients/viewer/web/', import.meta.url);
const require = createRequire(new URL('package.json', web));
export const CHROMIUM = process.env.PALPATE_CHROMIUM ?? '/usr/bin/chromium';
const SHELL = '/usr/bin/chromium-headless-shell';
/** The browser without windows and tabs of its own, which take processor time too, where there is one. */
export const BARE_CHROMIUM = !process.env.PALPATE_CHROMIUM && existsSync(SHELL) ? SHELL : CHROMIUM;
const shots = process.env.PALPATE_SHOTS ?? '/tmp/palpate-viewer-shots';

/** The package of that name, in the version of the page's lock file. */
export const packageOf = (name) => require(name);

/** Without a browser or a page, says so and ends the program; ctest counts it as skipped. */
export function skipWithoutBrowser() {
  const lacks = !existsSync(CHROMIUM)
    ? `no ${CHROMIUM}: tools/install_packages installs it`
    : !existsSync(new URL('dist/index.html', web)) || !existsSync(new URL('node_modules/playwright-core', web))
      ? 'the page is not built: npm could not fetch its packages'
      : '';
  if (!lacks) return;
  console.log(`SKIPPED: ${lacks}`);
  process.exit(0);
}

/** @param executablePath  of chromium, or of a program that becomes it */
export async function openBrowser(executablePath = CHROMIUM) {
  const args = ['--enable-unsafe-swiftshader', ...(process.getuid() === 0 ? ['--no-sandbox'] : [])];
  return packageOf('playwright-core').chromium.launch({ executablePath, args });
}

/**
 * The page as a user sees it: `see` gives pictures, `figures` the panel's numbers. Errors of its scripts, and what the
 * content security policy forbids it, fail the test that closes it.
 */
export class Seen {
  static async open(browser, address, { width = 1000, height = 700, dark = false, phone = false } = {}) {
    const seen = new Seen();
    const size = phone ? { width: 390, height: 844 } : { width, height };
    seen.context = await browser.newContext({
      viewport: size, colorScheme: dark ? 'dark' : 'light', hasTouch: phone, isMobile: phone, acceptDownloads: true,
      ignoreHTTPSErrors: true, // a test's certificate signed itself
    });
    seen.page = await seen.context.newPage();
    seen.errors = [];
    seen.page.on('pageerror', (error) => seen.errors.push(error.message));
    seen.page.on('console', (message) => {
      if (/content security policy/i.test(message.text())) seen.errors.push(message.text());
    });
    await seen.page.goto(address);
    return seen;
  }

  figures() {
    return this.page.evaluate(() => window.palpate.figures());
  }

  /** What the health panel prints, by name. */
  panel() {
    return this.page.evaluate(() =>
      Object.fromEntries([...document.querySelectorAll('#health-list dt')].map((dt) => [dt.textContent, dt.nextElementSibling.textContent])));
  }

  /** Waits until a test of the figures holds. @throws Error with the figures when it takes longer */
  async until(what, holds, seconds = 20) {
    let figures;
    for (const end = Date.now() + 1000 * seconds; Date.now() < end; await this.page.waitForTimeout(50)) {
      figures = await this.page.evaluate(() => window.palpate?.figures());
      if (figures && holds(figures)) return figures;
    }
    throw new Error(`not within ${seconds} s: ${what}; ${JSON.stringify(figures)}`);
  }

  /** Waits until nothing new has been drawn for half a second, for at most 5 s (a page that is pressed may go on). */
  async settled() {
    await this.page.waitForTimeout(500);
    let pictures = -1;
    for (const end = Date.now() + 5000; Date.now() < end; await this.page.waitForTimeout(500)) {
      const now = (await this.figures()).pictures;
      if (now === pictures) return;
      pictures = now;
    }
  }

  organ() {
    return this.until('an organ is seen', (f) => f.nodes > 0 && f.organSeenMs > 0);
  }

  /** The middle of the picture of the organ, and its size, CSS pixels. */
  async middle() {
    const box = await this.page.locator('#organ').boundingBox();
    return { x: box.x + box.width / 2, y: box.y + box.height / 2, width: box.width, height: box.height };
  }

  /** What is on the screen within `clip`: CSS pixels. */
  async see(clip) {
    return decodePng(await this.page.screenshot({ clip, scale: 'css' }));
  }

  /** A square round a place. */
  around(place, half) {
    return this.see({ x: place.x - half, y: place.y - half, width: 2 * half, height: 2 * half });
  }

  /** @param waitMs  until the sharp picture, drawn at rest */
  async shot(name, waitMs = 700) {
    mkdirSync(shots, { recursive: true });
    await this.page.waitForTimeout(waitMs);
    await this.page.screenshot({ path: join(shots, `${name}.png`) });
  }

  async close() {
    const { errors } = this;
    await this.context.close();
    if (errors.length) throw new Error(`errors in the page: ${errors.join('; ')}`);
  }
}
