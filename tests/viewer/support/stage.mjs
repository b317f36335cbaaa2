// SPDX-License-Identifier: Apache-2.0
// What nearly every file of tests here needs: server, viewer and browser, up before its tests and gone after them.
import { after, afterEach, before, beforeEach } from 'node:test';
import { openBrowser, Seen, skipWithoutBrowser } from './browser.mjs';
import { Bench } from './processes.mjs';

export let bench, viewer, browser, seen;

const openPage = async () => {
  seen = await Seen.open(browser, viewer.address);
  await seen.organ();
};
const closePage = () => seen?.close();

/**
 * Call once, before the tests; skips the file where there is no browser.
 * @param model of the server, by the bench; absent: the tests' round organ
 * @param server more options of the server
 * @param more options of the viewer, by the bench
 * @param serve false: neither server nor viewer runs until a test starts them
 * @param page 'once': one page for all tests, as `seen`; 'each': a new one for each
 */
export function stage({ model = () => bench.model(), server = [], more = () => [], serve = true, page } = {}) {
  skipWithoutBrowser();
  before(async () => {
    bench = await Bench.open();
    if (serve) {
      await bench.server(model(), server);
      viewer = await bench.viewer(0, more());
    }
    browser = await openBrowser();
    if (page === 'once') await openPage();
  });
  if (page === 'each') {
    beforeEach(openPage);
    afterEach(closePage);
  }
  after(async () => {
    if (page === 'once') await closePage();
    await browser?.close();
    await bench?.close();
  });
}
