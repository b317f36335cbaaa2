// SPDX-License-Identifier: Apache-2.0
// Keeps the page, core and one model in this browser, for times without a network. docs/decisions/offline.md
const STAMPS = ['etag', 'last-modified', 'content-length'];

/** Names of this page's caches, the oldest first; those of other pages of the same web server are not ours. */
const prefix = (): string => `palpate ${new URL('./', location.href).href} `;
const ours = async (): Promise<string[]> => (await caches.keys()).filter((name) => name.startsWith(prefix())).sort();

/** Whether the web server still has what is kept. One that says neither ETag nor date is taken to have something else. */
async function unchanged(kept: Cache | undefined, address: string): Promise<boolean> {
  const copy = await kept?.match(address, { ignoreVary: true });
  if (!copy) return false;
  const now = await fetch(address, { method: 'HEAD', cache: 'no-store' });
  const dated = now.headers.has('etag') || now.headers.has('last-modified');
  return now.ok && dated && STAMPS.every((stamp) => now.headers.get(stamp) === copy.headers.get(stamp));
}

/** What is to be kept: all that the page may ask for, so that any model file can be pressed later. */
async function wanted(model: string): Promise<string[]> {
  const answer = await fetch('./files.json', { cache: 'no-cache' });
  if (!answer.ok) throw new Error(`files.json: the web server answers ${answer.status}`);
  const files = (await answer.json()) as string[];
  const all = ['./', './files.json', ...files, ...(model ? [model] : [])];
  return [...new Set(all.map((file) => new URL(file, location.href).href))];
}

/** The copies of before stay until the new ones are there, all of them. */
async function copy(model: string): Promise<void> {
  const before = await ours();
  const kept = before[0] === undefined ? undefined : await caches.open(before[0]);
  const files = await wanted(model);
  const same = await Promise.all(files.map((file) => unchanged(kept, file)));
  if (same.every(Boolean) && (await kept?.keys())?.length === files.length) return;
  const name = prefix() + new Date().toISOString();
  try {
    await (await caches.open(name)).addAll(files.map((file) => new Request(file, { cache: 'no-cache' })));
  } catch (error) {
    await caches.delete(name);
    throw error;
  }
  for (const old of before) await caches.delete(old);
}

/** Lets people put the page on their home screen. palpate-viewer's page names no manifest: it is not for installing. */
function nameManifest(): void {
  const link = document.createElement('link');
  link.rel = 'manifest';
  link.href = './palpate.webmanifest';
  document.head.append(link);
}

/** From now on this page works without its web server. @return empty, or why not */
export async function keep(model: string): Promise<string> {
  if (!('serviceWorker' in navigator) || !('caches' in window)) return 'no: needs https or localhost';
  try {
    await navigator.serviceWorker.register('./offline.js');
    nameManifest();
    await copy(model);
  } catch (error) {
    if ((await ours()).length === 0) return `no: ${error instanceof Error ? error.message : String(error)}`;
  }
  return '';
}

/** A palpate-viewer's page is always its own: nothing that another page left at this address comes in its place. */
export async function forget(): Promise<void> {
  if (!('serviceWorker' in navigator) || !('caches' in window)) return;
  const worker = await navigator.serviceWorker.getRegistration('./');
  if (worker?.scope === new URL('./', location.href).href) await worker.unregister();
  for (const name of await ours()) await caches.delete(name);
}
