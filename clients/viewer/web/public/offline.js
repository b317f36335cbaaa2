// SPDX-License-Identifier: Apache-2.0
// The page's service worker: what the web server has, and the copies that src/offline.ts keeps only where it does not answer.
const page = self.registration.scope;

async function kept(request) {
  const names = (await caches.keys()).filter((name) => name.startsWith(`palpate ${page} `)).sort();
  if (names.length === 0) return undefined;
  const cache = await caches.open(names[0]); // a newer one is not yet whole
  return cache.match(request.mode === 'navigate' ? page : request.url, { ignoreVary: true });
}

/** Asks the web server whether what the browser has is still so. */
function fromServer(request) {
  if (request.mode === 'navigate') return fetch(request.url, { cache: 'no-cache', redirect: 'manual' });
  return request.cache === 'default' ? fetch(request, { cache: 'no-cache' }) : fetch(request);
}

async function answer(request) {
  try {
    const now = await fromServer(request);
    return now.status >= 500 ? ((await kept(request)) ?? now) : now;
  } catch {
    return (await kept(request)) ?? Response.error();
  }
}

self.addEventListener('install', () => self.skipWaiting());
self.addEventListener('activate', (event) => event.waitUntil(self.clients.claim()));
self.addEventListener('fetch', (event) => {
  if (event.request.method === 'GET') event.respondWith(answer(event.request));
});
