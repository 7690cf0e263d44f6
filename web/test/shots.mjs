// Screenshots at several settings: node web/test/shots.mjs URL FOLDER [CHROMIUM [NAME]]

import { writeFileSync } from 'node:fs';
import { join } from 'node:path';

import { open } from './browser.mjs';

const [url, folder, program = 'chromium', only = ''] = process.argv.slice(2);
const run = (setting, at, rest) => `${url}#seed=1&plan=0:${setting}&at=${at}&${rest}`;
const PHONE = { width: 390, height: 844, mobile: true };
const SHOTS = [
  ['one', run('0.03,0,0.015625,0.1,10', 3000, 'speed=300'), {}],
  ['two', run('0.08,0,0.015625,0.1,10', 2000, 'speed=300'), {}],
  ['collapse', run('0.3,0.03,0.015625,0.1,10', 1500, 'speed=300'), {}],
  ['slow', run('0.03,0,0.015625,0.1,10', 2000, 'speed=0.05'), {}],
  ['dark', run('0.08,0,0.015625,0.1,10', 2000, 'speed=300'), { dark: true }],
  ['two-runs', run('0.03,0,0.015625,0.1,10', 2500, 'speed=300&beside=0:0.08'), {}],
  ['outside', run('0.08,0.2,0.1,0.1,10', 300, 'speed=300'), {}],
  ['nut', run('0.3,0.05,1,1,2.3', 150, 'speed=10&nut=6,1'), {}],
  ['phone', run('0.08,0,0.015625,0.1,10', 2000, 'speed=300'), PHONE],
  ['phone-dark', run('0.08,0,0.015625,0.1,10', 2000, 'speed=300'), { ...PHONE, dark: true }],
  ['phone-two-runs', run('0.03,0,0.015625,0.1,10', 1500, 'speed=300&beside=0:0.08'), PHONE],
  ['phone-nut', run('0.3,0.05,1,1,2.3', 60, 'speed=10&nut=4,4'), PHONE],
];

for (const [name, address, size] of SHOTS.filter(([name]) => name.startsWith(only))) {
  const page = await open(program, size);
  await page.go(address);
  await page.until('!rolls.frame.isReplaying && (rolls.frame.state !== "" || rolls.run.nut[0] > 0)', 150);
  await new Promise((resolve) => setTimeout(resolve, 1500));
  writeFileSync(join(folder, `${name}.png`), await page.screenshot(size.mobile));
  console.log(name, await page.evaluate('document.getElementById("state").textContent + "; " + document.getElementById("rates").textContent'), page.problems.join('; '));
  await page.close();
}
