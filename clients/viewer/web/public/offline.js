// SPDX-License-Identifier: Apache-2.0
// The page's service worker: what the web server has, and the copies that src/offline.ts keeps only where it does not answer.
// Of other pages below its own, and of what it has no copy of, it changes nothing.
const page = self.registration.scope;
const isPage = (address) => [page, `${page}index.html`].includes(address.replace(/[?#].*/, ''));

/** The newest whole cache: its files.json was written last. */
async function copies() {
  const names = (await caches.keys()).filter((name) => name.startsWith(`palpate ${page} `)).sort().reverse();
  for (const name of names) {
    const cache = await caches.open(name);
    if (await cache.match(`${page}files.json`, { ignoreVary: true })) return cache;
  }
  return undefined;
}

/** Asks the web server whether what the browser has is still so. */
function fromServer(request) {
  if (request.mode === 'navigate') return fetch(request.url, { cache: 'no-cache', redirect: 'manual' });
  return request.cache === 'default' ? fetch(request, { cache: 'no-cache' }) : fetch(request);
}

async function answer(request) {
  const copy = await (await copies())?.match(request.mode === 'navigate' ? page : request.url, { ignoreVary: true });
  if (!copy) return fetch(request);
  try {
    const now = await fromServer(request);
    return now.status >= 500 ? copy : now;
  } catch {
    return copy;
  }
}

self.addEventListener('install', () => self.skipWaiting());
self.addEventListener('activate', (event) => event.waitUntil(self.clients.claim()));
self.addEventListener('fetch', (event) => {
  const { request } = event;
  if (request.method === 'GET' && (request.mode !== 'navigate' || isPage(request.url))) event.respondWith(answer(request));
});
