// SPDX-License-Identifier: Apache-2.0
// Keeps the page, core and one model in this browser, for times without a network. docs/decisions/offline.md
const absolute = (file: string): string => new URL(file, location.href).href;
const LIST = './files.json'; // written last: a cache without it is not whole (public/offline.js too)

/** Names of this page's caches, the newest first; those of other pages of the same web server are not ours. */
const prefix = (): string => `palpate ${absolute('./')} `;
const ours = async (): Promise<string[]> => (await caches.keys()).filter((name) => name.startsWith(prefix())).sort().reverse();

interface Kept {
  readonly name: string;
  readonly cache: Cache;
  readonly list: readonly string[]; // of LIST, absolute
}

/** The newest cache that is whole. */
async function kept(): Promise<Kept | undefined> {
  for (const name of await ours()) {
    const cache = await caches.open(name);
    const list = await cache.match(absolute(LIST), { ignoreVary: true });
    if (list) return { name, cache, list: ((await list.json()) as string[]).map(absolute) };
  }
  return undefined;
}

/** The model among the copies, if there is one: what neither is the page nor on its list. */
async function modelIn({ cache, list }: Kept): Promise<string> {
  const all = (await cache.keys()).map(({ url }) => url);
  return all.find((url) => ![absolute('./'), absolute(LIST), ...list].includes(url)) ?? '';
}

/** What names a version: web servers that pack what they send weaken the ETag and give another length. */
const stampOf = ({ headers }: Response): string | null => headers.get('etag')?.replace(/^W\//, '') ?? headers.get('last-modified');

/** The copy of what the web server still has so. One that says neither ETag nor date is taken to have something else. */
async function unchanged(cache: Cache | undefined, address: string): Promise<Response | undefined> {
  const copy = await cache?.match(address, { ignoreVary: true });
  if (!copy) return undefined;
  const now = await fetch(address, { method: 'HEAD', cache: 'no-store' });
  return now.ok && stampOf(now) !== null && stampOf(now) === stampOf(copy) ? copy : undefined;
}

/** Copies all that the page may ask for, so that any model file can be pressed later. @return the name of the whole cache */
async function copied(model: string, before: Kept | undefined): Promise<string> {
  const list = await fetch(LIST, { cache: 'no-cache' });
  if (!list.ok) throw new Error(`files.json: the web server answers ${list.status}`);
  const listed = (await list.clone().json()) as string[];
  const files = [...new Set(['./', ...listed, ...(model ? [model] : [])].map(absolute))];
  const same = await Promise.all(files.map((file) => unchanged(before?.cache, file)));
  if (before && same.every(Boolean) && (await before.cache.keys()).length === files.length + 1) return before.name;
  const name = prefix() + new Date().toISOString();
  const cache = await caches.open(name);
  await Promise.all(files.map((file, i) => (same[i] ? cache.put(file, same[i]) : cache.add(new Request(file, { cache: 'no-cache' })))));
  await cache.put(absolute(LIST), list);
  return name;
}

/** The copies of before stay until the new ones are there, all of them; then, or when that fails, whatever else there is goes. */
async function copy(model: string): Promise<void> {
  const before = await kept();
  let good = before?.name;
  try {
    good = await copied(model || (before ? await modelIn(before) : ''), before);
  } finally {
    for (const name of await ours()) if (name !== good) await caches.delete(name);
  }
}

/** Lets people put the page on their home screen. palpate-viewer's page names no manifest: it is not for installing. */
function nameManifest(): void {
  const link = document.createElement('link');
  link.rel = 'manifest';
  link.href = './palpate.webmanifest';
  document.head.append(link);
}

/** From now on this page works without its web server. @param model  its address; empty: the one kept stays  @return empty, or why not */
export async function keep(model: string): Promise<string> {
  if (!('serviceWorker' in navigator) || !('caches' in window)) return 'no: needs https or localhost';
  try {
    await navigator.serviceWorker.register('./offline.js');
    nameManifest();
    await navigator.locks.request(prefix(), () => copy(model)); // one page at a time
  } catch (error) {
    const has = await (await kept())?.cache.match(model || absolute('./'), { ignoreVary: true });
    if (!has) return `no: ${error instanceof Error ? error.message : String(error)}`;
  }
  return '';
}

/** A palpate-viewer's page is always its own: nothing that another page left at this address comes in its place. */
export async function forget(): Promise<void> {
  if (!('serviceWorker' in navigator) || !('caches' in window)) return;
  const worker = await navigator.serviceWorker.getRegistration('./');
  if (worker?.scope === absolute('./')) await worker.unregister();
  for (const name of await ours()) await caches.delete(name);
}
