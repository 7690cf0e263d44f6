// The page: controls on one side, on the other frames of the run in its worker, and of a second one beside it.

import { Diagram, isLarger, reducedGravity, setOf } from './diagram.js';
import { look } from './look.js';
import { Order } from './order.js';
import { canRecord, record, save, saveAs } from './picture.js';
import { ROLLS, sceneOf } from './scenes.js';
import { Side } from './side.js';
import { Sliders, fromAddress, positionOf, refused, speedOf, toAddress } from './settings.js';

const at = (id) => document.getElementById(id);
const say = (text) => { at('message').textContent = text; };
const signed = (value) => (value < 0 ? '−' : '') + Math.abs(value).toFixed(3);
const short = (value) => Number(value.toPrecision(3));

const plot = new Order(at('order'));
const sliders = new Sliders(at('sliders'), () => ask(), say);
const diagram = new Diagram(at('diagram'), (friction, q) => {
  const [first, second] = sceneOf(run).settings;
  sliders.show([first.round(friction), second.round(q), ...sliders.values.slice(2)]);
  ask();
});

let run = fromAddress(location.hash); // Scene, seed, plan, speed, whether it plays, and what differs in the run beside it.
let other = null; // The run beside it.
let asked = 0, askLater = 0, shownSet = null;
const drawn = { since: performance.now(), frames: 0, perSecond: 0 };

const broke = (text) => { say(`The run stopped: ${text}. Restart, or choose other settings.`); run.isPlaying = false; showPlaying(); };
const side = new Side(at('box'), {
  loaded() { start(run); side.order('want'); requestAnimationFrame(draw); },
  asked(_, message) { changes(message); },
  refused(text) { say(`These settings were refused: ${text}.`); sliders.show(run.plan.at(-1).setting); },
  arrived() { for (const step of run.plan.slice(1)) plot.changed(step.at); },
  lines(lines, { larger }) { const set = shownSet; if (larger === isLarger(set)) diagram.load(set, lines); },
  error: broke,
}, (frame) => plot.add(frame.samples));
// For tests and for the curious.
window.rolls = { get frame() { return side.frame; }, get beside() { return other?.frame; }, get run() { return run; }, drawn };

function start(next) {
  run = next;
  document.body.dataset.scene = run.scene.name;
  document.title = at('title').textContent = run.scene.title;
  say(run.wrong.length > 0 ? `The address holds ${run.wrong.join(' and ')}; this is the run from the start.` : '');
  plot.begin(run.scene); diagram.begin();
  sliders.make(run.scene);
  sliders.show(run.plan.at(-1).setting);
  at('beside').replaceChildren(new Option('nothing', ''), ...run.scene.settings.map(({ symbol, name }, i) => new Option(`another ${symbol} (${name})`, i)));
  at('seed').value = run.seed;
  at('speed').value = positionOf(run.speed);
  tellSpeed();
  side.start(run);
  showPlaying();
  showLines();
  showBeside(run.at);
}

// Marks the run among those to begin with.
function showCurrent() {
  const essence = ({ nut, beside }, setting) => JSON.stringify([nut, setting, beside]);
  for (const link of document.querySelectorAll('nav a')) {
    const first = fromAddress(link.hash);
    link.setAttribute('aria-current', essence(first, first.plan[0].setting) === essence(run, sliders.values));
  }
}

// Starts the run beside, from the plan of this one with another value of one setting, and replays it as far; or takes it away.
function showBeside(until = Math.floor(side.frame?.oscillations ?? 0)) {
  const { beside } = run;
  at('beside').value = beside?.setting ?? '';
  at('beside-value').hidden = !beside;
  at('beside-value').value = beside?.value ?? '';
  document.body.classList.toggle('two', Boolean(beside));
  other?.end();
  other = null;
  showCurrent();
  if (!beside) return;
  other = new Side(at('box-beside'), {
    loaded() { other.start({ ...run, plan: run.plan.map(varied), at: until }); other.order('want'); },
    error: (text) => broke(`${text}, beside it`),
  }, (frame) => plot.add(frame.samples, 1));
}

const varied = ({ at: when, setting }) => ({ at: when, setting: setting.with(run.beside.setting, run.beside.value) });
const both = (name, argument) => { side.order(name, argument); other?.order(name, argument); };

function play(isPlaying) {
  run.isPlaying = isPlaying;
  for (const each of [side, other]) each?.box.clearSteps();
  both('play', isPlaying);
  showPlaying();
}
function showPlaying() { at('play').textContent = run.isPlaying ? 'Pause' : 'Play'; }

// A slider that is dragged asks a few times a second, so that the plan stays short.
function ask() {
  clearTimeout(askLater);
  const wait = asked + 120 - performance.now();
  if (wait > 0) { askLater = setTimeout(ask, wait); return; }
  asked = performance.now();
  side.order('ask', [...sliders.values]);
  showLines();
  showCurrent();
}

function changes({ asked, setting }) {
  const step = { at: asked, setting };
  run.plan = [...run.plan.filter((earlier) => earlier.at < asked), step];
  plot.changed(asked);
  side.box.clearSteps();
  other?.order('follow', varied(step));
}

// The recorded runs are of two reduced gravities; the nearer one is shown.
function showLines() {
  if (run.scene !== ROLLS) return;
  const set = setOf(sliders.values), own = reducedGravity(sliders.values);
  at('diagram-gravity').textContent = set.gravity;
  at('own-gravity').textContent = short(own) === short(Number(set.gravity)) ? '' : `this run has ${short(own)}; `;
  if (set !== shownSet) { shownSet = set; side.order('lines', [isLarger(set), set.most]); }
}

function tellSpeed() {
  at('speed-text').textContent = run.speed === Infinity ? 'as fast as it goes' : `${run.speed} oscillations/s`;
}

function stateOf({ isReplaying, until, state, numbers: [large, rest] }) {
  if (isReplaying) return `replaying to ${until} …`;
  if (run.scene !== ROLLS) return `large disk ${Math.abs(large - rest).toFixed(1)} ${large < rest ? 'below' : 'above'} the mean of the others`;
  return state || 'settling …';
}

function captionOf(frame, value) {
  return `${run.scene.settings[run.beside.setting].symbol} = ${value}, after ${Math.floor(frame.oscillations)} oscillations: ${stateOf(frame)}`;
}

function show(frame) {
  const [first, second, height] = frame.numbers;
  const format = run.scene === ROLLS ? signed : (value) => value.toFixed(1);
  at('oscillations').textContent = run.speed < 10 || !run.isPlaying ? frame.oscillations.toFixed(2) : Math.floor(frame.oscillations);
  at('first').textContent = format(first);
  at('second').textContent = format(second);
  at('fastest').textContent = side.box.fastest.toFixed(2);
  at('height').textContent = height.toFixed(1);
  at('state').textContent = stateOf(frame);
  at('hash').textContent = frame.hash.text;
  at('hash-at').textContent = frame.hash.at;
  const [perSecond, collisions] = frame.perSecond.map((rate) => (rate < 10 ? rate.toFixed(2) : Math.round(rate).toLocaleString('en')));
  at('rates').textContent = `${perSecond} oscillations and ${collisions} collisions per second, ${drawn.perSecond.toFixed(0)} frames per second`;
  if (!run.beside) return;
  at('caption').textContent = captionOf(frame, sliders.values[run.beside.setting]);
  if (other?.frame) at('caption-beside').textContent = captionOf(other.frame, run.beside.value);
}

function draw() {
  requestAnimationFrame(draw);
  const options = { color: at('color').value, arrows: at('arrows').checked, isSlow: run.speed < run.scene.speed / 100 || !run.isPlaying };
  // Neither leaves the other behind, and the one beside is never ahead: each follows a frame later, sixty times a second.
  const lead = Math.max(1, Math.min(run.speed, 300) / 30);
  other?.draw(options, side.frame?.oscillations);
  if (!side.draw(options, other ? (other.frame?.oscillations ?? 0) + lead : undefined)) return;
  plot.draw();
  if (run.scene === ROLLS) diagram.draw(sliders.values, run.beside && varied({ setting: sliders.values }).setting);
  if (drawn.frames % 4 === 0 || !run.isPlaying) show(side.frame);
  drawn.frames += 1;
  const passed = performance.now() - drawn.since;
  if (passed > 1000) Object.assign(drawn, { since: performance.now(), perSecond: (1000 * drawn.frames) / passed, frames: 0 });
}

function address() {
  const whole = Math.max(side.frame?.hash.at ?? 0, run.plan.at(-1).at);
  return toAddress({ ...run, at: whole });
}

at('play').onclick = () => play(!run.isPlaying);
at('step').onclick = () => { run.isPlaying = false; showPlaying(); both('step'); };
at('restart').onclick = () => { start({ ...run, plan: [{ at: 0, setting: [...sliders.values] }], at: 0, isPlaying: true, wrong: [] }); };
at('seed').onchange = () => {
  const fault = refused(at('seed'), { symbol: 'seed', least: 0, most: 2 ** 32 - 1 }) || (at('seed').checkValidity() ? '' : 'A seed is a whole number.');
  say(fault);
  if (fault) at('seed').value = run.seed; else { run.seed = Number(at('seed').value); at('restart').click(); }
};
at('speed').oninput = () => { run.speed = speedOf(Number(at('speed').value)); tellSpeed(); both('speed', run.speed); };
// A value that differs visibly from this run's: half of it, or the middle of the slider where that is 0.
function another(index) {
  const setting = run.scene.settings[index], value = sliders.values[index];
  return setting.round(value > setting.least ? Math.max(value / 2, setting.least) : setting.to(0.5));
}
at('beside').onchange = () => {
  const setting = at('beside').value;
  run.beside = setting === '' ? null : { setting: Number(setting), value: another(Number(setting)) };
  showBeside();
};
at('beside-value').onchange = () => {
  const fault = refused(at('beside-value'), run.scene.settings[run.beside.setting]);
  say(fault);
  if (!fault) run.beside.value = Number(at('beside-value').value);
  showBeside();
};
at('share').onclick = async () => {
  history.replaceState(null, '', address());
  const done = await navigator.clipboard?.writeText(location.href).then(() => true, () => false);
  at('share').textContent = done ? 'Link copied' : 'Link is in the address bar';
  setTimeout(() => { at('share').textContent = 'Copy link to this moment'; }, 2000);
};
at('save').onclick = () => {
  const { frame } = side, isRolls = run.scene === ROLLS;
  const names = ['first', 'second'].map((id, k) => [at(`${id}-name`).innerText.trim(), [look.one, look.two][k]]);
  const plots = [{ canvas: plot.canvas, names }, ...(isRolls ? [{ canvas: diagram.canvas, names: [['states in the plane of friction and inelasticity', look.ink]] }] : [])];
  if (frame) save({
    title: `${frame.disks.length / 5} disks after ${Math.floor(frame.oscillations)} oscillations: ${stateOf(frame)}`,
    about: run.scene.settings.map(({ symbol }, i) => `${symbol} = ${sliders.values[i]}`).join('    ') + (run.beside ? `    beside it: ${run.scene.settings[run.beside.setting].symbol} = ${run.beside.value}` : ''),
    foot: `seed ${run.seed}; state ${frame.hash.text} after ${frame.hash.at} oscillations; granular-edmd`,
    boxes: [side, other].filter(Boolean).map((each) => each.box.canvas), plots,
  }, named());
};
const named = () => `${run.scene.name}-${Math.floor(side.frame?.oscillations ?? 0)}`;
at('curves').onclick = () => saveAs(`${named()}.csv`, new Blob([plot.csv()], { type: 'text/csv' }));
at('record').hidden = !canRecord;
at('record').onclick = async () => {
  at('record').disabled = true;
  at('record').textContent = 'Recording …';
  await record(side.box.canvas, 8, named()).catch((error) => say(`No video: ${error.message}`));
  at('record').textContent = 'Record 8 seconds';
  at('record').disabled = false;
};
window.addEventListener('hashchange', () => start(fromAddress(location.hash)));
navigator.serviceWorker?.register('offline.js').catch(() => {}); // Where it is refused, the page needs the network.
