// Keeps the page for times without a network: always the newest files that the network gave.

const NAME = 'rolls';
const FILES = ['./', 'style.css', 'page.js', 'box.js', 'diagram.js', 'look.js', 'order.js', 'picture.js', 'scenes.js', 'settings.js', 'side.js',
  'worker.js', 'rolls.wasm', 'states-0.015625.csv', 'states-0.002025.csv'];

self.addEventListener('install', (event) => event.waitUntil(caches.open(NAME).then((cache) => cache.addAll(FILES)).then(() => self.skipWaiting())));
self.addEventListener('activate', (event) => event.waitUntil(self.clients.claim()));
self.addEventListener('fetch', (event) => {
  if (event.request.method === 'GET' && new URL(event.request.url).origin === self.location.origin) event.respondWith(answer(event.request));
});

async function answer(request) {
  const cache = await caches.open(NAME);
  try {
    const response = await fetch(request);
    if (response.ok) await cache.put(request, response.clone());
    return response;
  } catch (error) {
    const kept = await cache.match(request, { ignoreSearch: true });
    if (kept) return kept;
    throw error;
  }
}
