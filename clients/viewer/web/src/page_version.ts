// SPDX-License-Identifier: Apache-2.0
import type { Said } from './connection';

export const PROTOCOL = 2; // `protocol` of the viewer's hello that this page reads: PROTOCOL.md

const KEY = 'palpate-loaded-again-for';

/**
 * Whether the viewer speaks this page's protocol. A page that was open while the viewer was replaced is loaded again, once:
 * where the old page comes back, it stays and says so.
 * @param kept  what outlives the page, of its tab
 */
export function isOfThisVersion(hello: Said, kept: Pick<Storage, 'getItem' | 'setItem'>, loadAgain: () => void): boolean {
  const theirs = String(hello['protocol']);
  if (theirs === String(PROTOCOL)) return true;
  if (kept.getItem(KEY) === theirs) return false;
  kept.setItem(KEY, theirs);
  loadAgain();
  return false;
}
