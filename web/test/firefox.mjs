// Firefox without a window, by Marionette, its own protocol: no driver and no package is needed.

import { spawn } from 'node:child_process';
import { mkdtempSync, rmSync, writeFileSync } from 'node:fs';
import { connect } from 'node:net';
import { tmpdir } from 'node:os';
import { join } from 'node:path';

const PORT = 20000 + (process.pid % 20000);
const pause = (milliseconds) => new Promise((resolve) => setTimeout(resolve, milliseconds));

async function connected(seconds) {
  for (const end = Date.now() + 1000 * seconds; Date.now() < end; await pause(200)) {
    const socket = connect(PORT, '127.0.0.1');
    if (await new Promise((resolve) => { socket.once('connect', () => resolve(true)); socket.once('error', () => resolve(false)); })) return socket;
  }
  throw new Error(`Firefox did not open port ${PORT} within ${seconds} s`);
}

export async function open(program) {
  const profile = mkdtempSync(join(tmpdir(), 'rolls-'));
  writeFileSync(join(profile, 'user.js'), `user_pref("marionette.port", ${PORT});\n`);
  const child = spawn(program, ['--headless', '--no-remote', '--marionette', '--profile', profile], { stdio: 'ignore' });
  const socket = await connected(60), waiting = new Map();
  let rest = Buffer.alloc(0), number = 0;
  // A message is its length, a colon, and JSON: [1, number, error, result] of an answer.
  socket.on('data', (data) => {
    rest = Buffer.concat([rest, data]);
    for (;;) {
      const colon = rest.indexOf(':'), end = colon + 1 + Number(rest.subarray(0, Math.max(colon, 0)));
      if (colon < 0 || rest.length < end) return;
      const message = JSON.parse(rest.subarray(colon + 1, end));
      rest = rest.subarray(end);
      const reply = Array.isArray(message) && waiting.get(message[1]);
      if (reply && message[2]) reply.reject(new Error(message[2].message)); else if (reply) reply.resolve(message[3]);
    }
  });
  const call = (method, parameters = {}) => new Promise((resolve, reject) => {
    number += 1;
    waiting.set(number, { resolve, reject });
    const text = JSON.stringify([0, number, method, parameters]);
    socket.write(`${Buffer.byteLength(text)}:${text}`);
  });
  await call('WebDriver:NewSession', {});
  const evaluate = async (expression) => (await call('WebDriver:ExecuteScript', { script: `return ${expression}`, args: [], sandbox: null })).value;
  const until = async (condition, seconds = 60) => {
    for (const end = Date.now() + 1000 * seconds; !(await evaluate(condition)); await pause(100)) {
      if (Date.now() > end) throw new Error(`not within ${seconds} s: ${condition}`);
    }
  };
  return {
    evaluate, until,
    go: async (url) => {
      await call('WebDriver:Navigate', { url: 'about:blank' });
      await call('WebDriver:Navigate', { url });
      await until('Boolean(window.rolls?.frame)');
    },
    close: async () => {
      const ended = new Promise((resolve) => child.once('close', resolve));
      await call('Marionette:Quit', { flags: ['eForceQuit'] }).catch(() => {});
      await ended;
      socket.destroy();
      rmSync(profile, { recursive: true, force: true, maxRetries: 10, retryDelay: 100 });
    },
  };
}
