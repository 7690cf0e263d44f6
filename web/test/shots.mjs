// Screenshots at several settings: node web/test/shots.mjs URL FOLDER [CHROMIUM]

import { writeFileSync } from 'node:fs';
import { join } from 'node:path';

import { open } from './browser.mjs';

const [url, folder, program = 'chromium'] = process.argv.slice(2);
const run = (setting, at, rest) => `${url}#seed=1&plan=0:${setting}&at=${at}&${rest}`;
const SHOTS = [
  ['one', run('0.03,0,0.015625,0.1,10', 3000, 'speed=300'), {}],
  ['two', run('0.08,0,0.015625,0.1,10', 2000, 'speed=300'), {}],
  ['collapse', run('0.3,0.03,0.015625,0.1,10', 1500, 'speed=300'), {}],
  ['slow', run('0.03,0,0.015625,0.1,10', 2000, 'speed=0.05'), {}],
  ['phone', run('0.08,0,0.015625,0.1,10', 2000, 'speed=300'), { width: 390, height: 844, mobile: true }],
];

for (const [name, address, size] of SHOTS) {
  const page = await open(program, size);
  await page.go(address);
  await page.until('!rolls.frame.isReplaying && rolls.frame.state !== ""', 90);
  await new Promise((resolve) => setTimeout(resolve, 1500));
  writeFileSync(join(folder, `${name}.png`), await page.screenshot(size.mobile));
  console.log(name, await page.evaluate('document.getElementById("state").textContent + "; " + document.getElementById("rates").textContent'), page.problems.join('; '));
  await page.close();
}
