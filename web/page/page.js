// The page: controls on one side, frames of the run in its worker on the other.

import { Box } from './box.js';
import { Diagram, LARGER, SMALLER } from './diagram.js';
import { Order } from './order.js';
import { save } from './picture.js';
import { Sliders, fromAddress, positionOf, rounded, speedOf, toAddress } from './settings.js';

const at = (id) => document.getElementById(id);
const say = (text) => { at('message').textContent = text; };
const signed = (value) => (value < 0 ? '−' : '') + Math.abs(value).toFixed(3);

const worker = new Worker('worker.js');
const order = (name, argument) => worker.postMessage([name, argument]);

const box = new Box(at('box')), plot = new Order(at('order'));
const diagram = new Diagram(at('diagram'), (friction, q) => {
  sliders.show([rounded(0, friction), Math.round(q * 2000) / 2000, ...sliders.values.slice(2)]);
  ask();
});
const sliders = new Sliders(at('sliders'), () => ask());

let run = fromAddress(location.hash); // Seed, plan, speed, and whether it plays.
let shown = null, fresh = false, isStep = false, asked = 0, askLater = 0;
const drawn = { since: performance.now(), frames: 0, perSecond: 0 };
// For tests and for the curious.
window.rolls = { get frame() { return shown; }, get run() { return run; }, drawn, frames: 0 };

function start(next) {
  run = next;
  say(run.isBroken ? 'The address holds no whole plan; this is the run from the start.' : '');
  box.forget(); plot.forget(); diagram.forget();
  sliders.show(run.plan.at(-1).setting);
  at('seed').value = run.seed;
  at('speed').value = positionOf(run.speed);
  tellSpeed();
  order('speed', run.speed);
  order('start', run);
  showPlaying();
  showLines();
}

function play(isPlaying) { run.isPlaying = isPlaying; box.clearSteps(); order('play', isPlaying); showPlaying(); }
function showPlaying() { at('play').textContent = run.isPlaying ? 'Pause' : 'Play'; }

// A slider that is dragged asks a few times a second, so that the plan stays short.
function ask() {
  clearTimeout(askLater);
  const wait = asked + 120 - performance.now();
  if (wait > 0) { askLater = setTimeout(ask, wait); return; }
  asked = performance.now();
  order('ask', [...sliders.values]);
  showLines();
}

function changes({ asked, setting }) {
  run.plan = [...run.plan.filter((step) => step.at < asked), { at: asked, setting }];
  plot.changed(asked);
  box.clearSteps();
}

// The recorded runs are of two gravities; the nearer one is shown.
function showLines() {
  const set = sliders.values[2] > Math.sqrt(LARGER.gravity * SMALLER.gravity) ? LARGER : SMALLER;
  if (set !== showLines.set) { showLines.set = set; order('lines', [set === LARGER, set.most]); }
}

function tellSpeed() {
  at('speed-text').textContent = run.speed === Infinity ? 'as fast as it goes' : `${run.speed} oscillations/s`;
}

function show(frame) {
  at('oscillations').textContent = run.speed < 10 || !run.isPlaying ? frame.oscillations.toFixed(2) : Math.floor(frame.oscillations);
  at('psi1').textContent = signed(frame.numbers[1]);
  at('psi2').textContent = signed(frame.numbers[2]);
  at('fastest').textContent = box.fastest.toFixed(2);
  at('height').textContent = frame.numbers[3].toFixed(1);
  at('state').textContent = frame.isReplaying ? `replaying to ${frame.until} …` : frame.state || 'settling …';
  at('hash').textContent = frame.hash.text;
  at('hash-at').textContent = frame.hash.at;
  const [perSecond, collisions] = frame.perSecond.map((rate) => (rate < 10 ? rate.toFixed(2) : Math.round(rate).toLocaleString('en')));
  at('rates').textContent = `${perSecond} oscillations and ${collisions} collisions per second, ${drawn.perSecond.toFixed(0)} frames per second`;
}

function draw() {
  requestAnimationFrame(draw);
  if (!fresh) return;
  fresh = false;
  const isSlow = run.speed < 3 || !run.isPlaying;
  box.draw(shown, { color: at('color').value, arrows: at('arrows').checked, isSlow });
  plot.draw();
  diagram.draw(sliders.values[0], sliders.values[1]);
  if (drawn.frames % 4 === 0 || !run.isPlaying) show(shown);
  drawn.frames += 1;
  window.rolls.frames += 1;
  const passed = performance.now() - drawn.since;
  if (passed > 1000) Object.assign(drawn, { since: performance.now(), perSecond: (1000 * drawn.frames) / passed, frames: 0 });
  order('want');
}

const replies = {
  loaded() { start(run); order('want'); requestAnimationFrame(draw); },
  frame(frame) {
    shown = frame;
    fresh = true;
    plot.add(frame.samples);
    box.mark(frame.marks, isStep);
    if (at('color').value !== 'dye') box.dye(frame.disks);
    if (frame.marks.length > 0) isStep = false;
  },
  asked(_, message) { changes(message); },
  stepped() { isStep = true; },
  arrived() { for (const step of run.plan.slice(1)) plot.changed(step.at); },
  lines(lines, { larger }) { const set = larger ? LARGER : SMALLER; diagram.load(set, lines).then(() => { at('diagram-gravity').textContent = set.gravity; }); },
  error(text) { say(`The run stopped: ${text}. Restart, or choose other settings.`); run.isPlaying = false; showPlaying(); },
};

worker.onmessage = ({ data }) => { for (const name of Object.keys(data)) replies[name]?.(data[name], data); };
worker.onerror = (event) => say(`The run could not start: ${event.message}`);

function address() {
  const whole = Math.max(shown?.hash.at ?? 0, run.plan.at(-1).at);
  return toAddress({ ...run, at: whole });
}

at('play').onclick = () => play(!run.isPlaying);
at('step').onclick = () => { run.isPlaying = false; showPlaying(); order('step'); };
at('restart').onclick = () => { start({ ...run, plan: [{ at: 0, setting: [...sliders.values] }], at: 0, isPlaying: true, isBroken: false }); };
at('seed').onchange = () => { if (at('seed').checkValidity() && at('seed').value !== '') { run.seed = Number(at('seed').value); at('restart').click(); } };
at('speed').oninput = () => { run.speed = speedOf(Number(at('speed').value)); tellSpeed(); order('speed', run.speed); };
at('share').onclick = async () => {
  history.replaceState(null, '', address());
  const done = await navigator.clipboard?.writeText(location.href).then(() => true, () => false);
  at('share').textContent = done ? 'Link copied' : 'Link is in the address bar';
  setTimeout(() => { at('share').textContent = 'Copy link to this moment'; }, 2000);
};
at('save').onclick = () => { if (shown) save({ frame: shown, run, values: sliders.values, state: at('state').textContent }); };
window.addEventListener('hashchange', () => start(fromAddress(location.hash)));
worker.postMessage(['load']);
