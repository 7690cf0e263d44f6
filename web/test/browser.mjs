// Chromium without a window, spoken to through a pipe: no driver and no package is needed.

import { spawn } from 'node:child_process';
import { mkdtempSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';

const FLAGS = ['--headless', '--no-sandbox', '--disable-gpu', '--disable-quic', '--no-first-run', '--disable-background-networking',
  '--disable-component-update', '--disable-sync', '--disable-default-apps', '--disable-dev-shm-usage', '--remote-debugging-pipe'];

export async function open(program, { width = 1280, height = 900, mobile = false, dark = false } = {}) {
  const profile = mkdtempSync(join(tmpdir(), 'rolls-'));
  const child = spawn(program, [...FLAGS, `--user-data-dir=${profile}`, 'about:blank'], { stdio: ['ignore', 'ignore', 'ignore', 'pipe', 'pipe'] });
  const waiting = new Map(), listeners = [];
  let number = 0, rest = '';
  child.stdio[4].on('data', (data) => {
    const parts = (rest + data).split('\0');
    rest = parts.pop();
    for (const message of parts.map((part) => JSON.parse(part))) {
      const reply = waiting.get(message.id);
      if (!reply) { listeners.forEach((listen) => listen(message)); continue; }
      waiting.delete(message.id);
      if (message.error) reply.reject(new Error(message.error.message)); else reply.resolve(message.result);
    }
  });
  const send = (method, params = {}, sessionId) => new Promise((resolve, reject) => {
    number += 1;
    waiting.set(number, { resolve, reject });
    child.stdio[3].write(`${JSON.stringify({ id: number, method, params, sessionId })}\0`);
  });
  child.on('exit', () => waiting.forEach(({ reject }) => reject(new Error('the browser ended'))));
  const { targetId } = await send('Target.createTarget', { url: 'about:blank' });
  const { sessionId } = await send('Target.attachToTarget', { targetId, flatten: true });
  const call = (method, params) => send(method, params, sessionId);
  const problems = [], requests = [];
  listeners.push(({ method, params }) => {
    if (method === 'Runtime.exceptionThrown') problems.push(params.exceptionDetails.exception?.description ?? params.exceptionDetails.text);
    if (method === 'Log.entryAdded' && params.entry.level === 'error') problems.push(params.entry.text);
    if (method === 'Network.requestWillBeSent') requests.push(params.request.url);
  });
  for (const domain of ['Page', 'Runtime', 'Log', 'Network']) await call(`${domain}.enable`);
  await call('Emulation.setDeviceMetricsOverride', { width, height, deviceScaleFactor: mobile ? 2 : 1, mobile });
  await call('Emulation.setEmulatedMedia', { features: [{ name: 'prefers-color-scheme', value: dark ? 'dark' : 'light' }] });

  const evaluate = async (expression) => {
    const { result, exceptionDetails } = await call('Runtime.evaluate', { expression, awaitPromise: true, returnByValue: true });
    if (exceptionDetails) throw new Error(exceptionDetails.exception?.description ?? exceptionDetails.text);
    return result.value;
  };
  const until = async (condition, seconds = 60) => {
    const end = Date.now() + 1000 * seconds;
    while (!(await evaluate(condition))) {
      if (Date.now() > end) throw new Error(`not within ${seconds} s: ${condition}; the page says: ${await evaluate('document.getElementById("message")?.textContent')}`);
      await new Promise((resolve) => setTimeout(resolve, 100));
    }
  };
  return {
    problems, requests, evaluate, until, call,
    go: async (url) => { await call('Page.navigate', { url: 'about:blank' }); await call('Page.navigate', { url }); await until('Boolean(window.rolls?.frame)'); },
    screenshot: async (full = false) => Buffer.from((await call('Page.captureScreenshot', { format: 'png', captureBeyondViewport: full })).data, 'base64'),
    close: async () => {
      const ended = new Promise((resolve) => child.once('close', resolve));
      await send('Browser.close').catch(() => {});
      await ended;
      rmSync(profile, { recursive: true, force: true, maxRetries: 10, retryDelay: 100 });
    },
  };
}
