// SPDX-License-Identifier: Apache-2.0
// axe-core in the page, by the browser's own protocol: the page's content policy allows no script of others.
import { packageOf } from './browser.mjs';

/** What axe-core calls serious or critical, one line each: the rule, what it says, where. */
export async function seriousIn(page) {
  await page.evaluate(packageOf('axe-core').source);
  const { violations } = await page.evaluate(() => window.axe.run(document, { resultTypes: ['violations'] }));
  return violations
    .filter(({ impact }) => impact === 'serious' || impact === 'critical')
    .map(({ id, help, nodes }) => `${id}: ${help}: ${nodes.map(({ target, failureSummary }) => `${target} ${failureSummary}`).join('; ')}`);
}
