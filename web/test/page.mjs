// Tests the page: node web/test/page.mjs PROGRAM CHROMIUM [FIREFOX [AXE]]; the program is this package's binary, and axe the file of axe-core.

import { execFileSync, spawn } from 'node:child_process';
import { strict as assert } from 'node:assert';
import { readFileSync, readdirSync, statSync } from 'node:fs';
import { dirname, join } from 'node:path';

import { open } from './browser.mjs';
import { open as openFirefox } from './firefox.mjs';

const [program, chromium = 'chromium', firefox, axe] = process.argv.slice(2);
const SEED = 7;
const seconds = (count) => new Promise((resolve) => setTimeout(resolve, 1000 * count));
const step = (text) => console.log(text);

// The server on a free port, and the address that it prints.
const server = spawn(program, ['serve'], { stdio: ['ignore', 'pipe', 'inherit'] });
const url = await new Promise((resolve, reject) => {
  let printed = '';
  server.stdout.on('data', (data) => { printed += data; const found = /http:\S+/.exec(printed); if (found) resolve(found[0]); });
  server.on('exit', () => reject(new Error('the server ended')));
});
let page = await open(chromium);
const plan = (...steps) => steps.map(([at, setting]) => `${at}:${setting.join(',')}`).join(';');
const go = async (text, at, rest) => page.go(`${url}#seed=${SEED}&plan=${text}&at=${at}&${rest}`);
const frame = (member) => page.evaluate(`rolls.frame.${member}`);
const set = (id, value, event) => page.evaluate(`{ const at = document.getElementById('${id}'); at.value = ${value};
  at.dispatchEvent(new Event('${event}')); }`);
const arrived = () => page.until('!rolls.frame.isReplaying', 60);

try {
  // As somebody who opens the page finds it.
  await page.go(url);
  await page.until('rolls.frame.oscillations > 20');
  const before = await page.evaluate('Array.from(rolls.frame.disks)');
  await seconds(0.5);
  const after = await page.evaluate('Array.from(rolls.frame.disks)');
  assert.equal(before.length, 5000);
  const moved = before.filter((number, i) => number !== after[i]).length;
  assert.ok(moved > 3000, `${moved} of 5000 numbers changed`);
  step(`disks move: ${moved} of 5000 numbers changed in half a second`);

  // Two settings one after the other: rule, gravity, amplitude and frequency change on the way.
  const steps = plan([0, [0.03, 0, 0.015625, 0.1, 10]], [40, [0.05, 0.01, 0.01, 0.1, 10]], [75, [0.05, 0.01, 0.01, 0.12, 8]]);
  await go(steps, 150, 'paused');
  await page.until('rolls.frame.hash.at === 150');
  const native = execFileSync(program, ['hash', String(SEED), steps, '150']).toString().trim();
  assert.equal(await frame('hash.text'), native);
  step(`the hash is that of the native run: ${native}`);

  // Single collisions, and sliders.
  const count = await frame('collisions');
  await page.evaluate('document.getElementById("step").click()');
  await page.until(`rolls.frame.collisions === ${count + 1}`);
  await set('speed', 1000, 'input');
  await page.evaluate('document.getElementById("play").click()');
  for (const [slider, id] of ['slider-0', 'slider-1', 'slider-2', 'slider-3', 'slider-4'].entries()) {
    const steps = await page.evaluate('rolls.run.plan.length');
    await set(id, 0.45, 'input');
    await page.until(`rolls.run.plan.length > ${steps}`);
    assert.notEqual(await page.evaluate(`rolls.run.plan.at(-1).setting[${slider}]`), [0.05, 0.01, 0.01, 0.12, 8][slider]);
  }
  // Keys move each slider at each press, and what was typed wrong is refused in words.
  for (const id of [0, 1, 2, 3, 4]) {
    for (const key of ['ArrowRight', 'ArrowRight', 'ArrowLeft', 'PageUp']) {
      const value = `Number(document.getElementById('value-${id}').value)`, before = await page.evaluate(value);
      await page.evaluate(`document.getElementById('slider-${id}').dispatchEvent(new KeyboardEvent('keydown', { key: '${key}', cancelable: true }))`);
      const now = await page.evaluate(value);
      assert.ok(key === 'ArrowLeft' ? now < before : now > before, `slider ${id}: ${before} to ${now} by ${key}`);
    }
  }
  await set('value-1', 0.4, 'change');
  assert.match(await page.evaluate('document.getElementById("message").textContent'), /q = 0.4 was refused: a number from 0 to 0.25/);
  await set('value-1', 0.01, 'change');
  assert.equal(await page.evaluate('document.getElementById("message").textContent'), '');
  step('keys move sliders, and a number out of range is refused in words');

  // The state is named a few times a second; a link leads to the last name, or to a later change. The changes
  // above come back from the worker, which a busy machine delays: none may come after the state was named.
  let changes = -1;
  while (changes !== (changes = await page.evaluate('rolls.run.plan.at(-1).at'))) await seconds(1);
  await page.until('rolls.frame.hash.at >= rolls.run.plan.at(-1).at');
  await page.evaluate('document.getElementById("play").click()');
  await seconds(0.7);
  const [shared, hash] = await page.evaluate('(document.getElementById("share").click(), [location.hash, rolls.frame.hash])');
  const [, text, at] = /plan=([^&]*)&at=(\d+)/.exec(shared);
  assert.equal(Number(at), hash.at);
  assert.equal(hash.text, execFileSync(program, ['hash', String(SEED), text, at]).toString().trim());
  step(`sliders act, and the shared address leads to the same state: ${hash.text} after ${at} oscillations`);

  // Convection: the same states as in the paper. One roll takes its time to come.
  for (const [friction, name] of [[0.03, 'one roll'], [0.08, 'two rolls']]) {
    await go(plan([0, [friction, 0, 0.015625, 0.1, 10]]), 2500, 'paused');
    await arrived();
    await page.until('rolls.frame.state !== ""');
    const state = await frame('state');
    assert.ok(state.startsWith(name), `κ = ${friction}: ${state}`);
    step(`κ = ${friction}: ${state}`);
  }

  // The other scene, and a run beside that differs in one setting: the bits of native runs, also after a change.
  await go(plan([0, [0.3, 0.05, 1, 1, 2.3]]), 12, 'nut=4,1&paused');
  await page.until('rolls.frame.hash.at === 12');
  assert.equal(await frame('hash.text'), execFileSync(program, ['hash', String(SEED), plan([0, [0.3, 0.05, 1, 1, 2.3]]), '12', '4,1']).toString().trim());
  step('a large disk among small ones: the hash of the native run');
  await go(plan([0, [0.03, 0, 0.015625, 0.1, 10]]), 30, 'beside=0:0.08&speed=50');
  await page.until('rolls.beside?.oscillations > 35');
  await set('value-2', 0.02, 'change');
  await page.until('rolls.run.plan.length === 2');
  const changed = await page.evaluate('rolls.run.plan[1].at');
  await page.until(`rolls.beside.hash.at > ${changed + 20}`);
  await page.evaluate('document.getElementById("play").click()');
  await seconds(0.7);
  const beside = await page.evaluate('rolls.beside.hash');
  const varied = plan([0, [0.08, 0, 0.015625, 0.1, 10]], [changed, [0.08, 0, 0.02, 0.1, 10]]);
  assert.equal(beside.text, execFileSync(program, ['hash', String(SEED), varied, String(beside.at)]).toString().trim());
  step(`a run beside it, with another friction: the hash of the native run after ${beside.at} oscillations`);

  // Speeds, printed and not judged: they are those of the machine.
  for (const speed of ['300', 'max']) {
    await go(plan([0, [0.03, 0, 0.015625, 0.1, 10]]), 600, `speed=${speed}`);
    await arrived();
    await seconds(3.5);
    const [oscillations, collisions] = await frame('perSecond');
    const frames = await page.evaluate('rolls.drawn.perSecond');
    assert.ok(oscillations > 0 && collisions > 0 && frames > 0);
    step(`speed ${speed}: ${oscillations.toFixed(0)} oscillations/s, ${collisions.toFixed(0)} collisions/s, ${frames.toFixed(0)} frames/s`);
  }

  // An address that cannot be: said, not hidden.
  await page.go(`${url}#plan=0:nonsense`);
  assert.match(await page.evaluate('document.getElementById("message").textContent'), /no whole plan/);
  await page.evaluate(`location.hash = '#seed=1&plan=0:-1,0,0.015625,0.1,10'`);
  await page.until('document.getElementById("message").textContent.includes("friction")');
  await page.evaluate('document.getElementById("restart").click()');
  await page.until('document.getElementById("message").textContent.includes("friction")');
  await page.evaluate(`location.hash = '#seed=1&plan=0:0.1,0,0.015625,0.1,10'`);
  await page.until('document.getElementById("message").textContent === "" && rolls.frame.oscillations > 5');
  assert.deepEqual(page.problems, []);
  const outside = page.requests.filter((request) => !request.startsWith(url) && !/^(about|blob|data):/.test(request));
  assert.deepEqual(outside, []);
  step('no errors, no requests elsewhere');

  // The choice among the first runs is marked, and what is seen can be saved: the curves as a table, the box as a video.
  await page.go(`${url}#seed=1&plan=0:0.08,0,0.015625,0.1,10`);
  await page.until('rolls.frame.oscillations > 5');
  const current = () => page.evaluate('Array.from(document.querySelectorAll("nav a[aria-current=true]"), (link) => link.textContent)');
  assert.deepEqual(await current(), ['two rolls']);
  await set('value-0', 0.07, 'change');
  assert.deepEqual(await current(), []);
  await page.evaluate('{ window.saved = []; URL.createObjectURL = (blob) => { saved.push(blob); return "data:,"; }; }');
  await page.evaluate('document.getElementById("curves").click()');
  const rows = (await page.evaluate('saved[0].text()')).trim().split('\n');
  assert.equal(rows[0], 'run,oscillations,one_roll,two_rolls,noise');
  assert.ok(rows.length > 1 && rows.slice(1).every((row) => /^0,\d+(,[-.e\d]+){3}$/.test(row)), rows.slice(0, 3).join(' '));
  assert.equal(await page.evaluate('document.getElementById("record").hidden'), false);
  await page.evaluate('document.getElementById("record").click()');
  await page.until('saved.length === 2', 30);
  const [type, size] = await page.evaluate('[saved[1].type, saved[1].size]');
  assert.ok(/^video/.test(type) && size > 1000, `${type} of ${size} bytes`);
  step(`${rows.length - 1} rows of curves; a video of ${size} bytes (${type})`);

  const folder = join(dirname(program), '../site'), bytes = readdirSync(folder).reduce((sum, name) => sum + statSync(join(folder, name)).size, 0);
  assert.ok(bytes < 650_000 || process.env.OPTIMIZED === '', `${bytes} bytes`);
  step(`${bytes} bytes in all, both diagrams and the library included`);

  if (axe) {
    for (const [name, size, rest] of [['light', {}, ''], ['dark', { dark: true }, ''], ['phone', { width: 390, height: 844, mobile: true }, ''],
      ['two runs', {}, '&beside=0:0.08'], ['large disk', { dark: true }, '&nut=4,1']]) {
      await page.close();
      page = await open(chromium, size);
      await page.go(`${url}#seed=1${rest}`);
      if (size.mobile) {
        const bottom = await page.evaluate('document.getElementById("box").getBoundingClientRect().bottom');
        assert.ok(bottom <= size.height, `the box ends at ${bottom} of ${size.height}`);
      }
      await page.evaluate(readFileSync(axe, 'utf8'));
      const found = await page.evaluate('axe.run().then(({ violations }) => violations.map(({ id, nodes }) => `${id}: ${nodes.map((node) => node.html).join(" ")}`))');
      assert.deepEqual(found, [], name);
    }
    step('axe finds nothing: light, dark, on a phone, with two runs, with a large disk');
  }

  if (firefox) {
    const fox = await openFirefox(firefox);
    try {
      await fox.go(`${url}#seed=${SEED}&plan=${steps}&at=150&paused`);
      await fox.until('rolls.frame.hash.at === 150');
      assert.equal(await fox.evaluate('rolls.frame.hash.text'), native);
      await fox.go(`${url}#seed=1`);
      await seconds(4);
      step(`Firefox: the hash of the native run, ${(await fox.evaluate('rolls.drawn.perSecond')).toFixed(0)} frames/s`);
    } finally { await fox.close(); }
  }

  // Without the server, everything still comes: from what the browser keeps.
  await page.go(url);
  await page.evaluate('navigator.serviceWorker.ready.then(() => true)');
  server.removeAllListeners('exit');
  const offline = new Promise((resolve) => server.once('close', resolve));
  server.kill();
  await offline;
  for (const rest of ['', '#nut=4,1', `#plan=${plan([0, [0.03, 0, 0.002025, 0.1, 10]])}`]) {
    await page.go(`${url}${rest}`);
    await page.until('rolls.frame.oscillations > 1');
  }
  step('works without its server, once loaded');
} finally {
  await page.close();
  server.removeAllListeners('exit');
  server.kill();
}
