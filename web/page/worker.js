// The run, in a thread of its own: advances at the speed asked for, and posts a frame whenever the page wants one.

const SLICE = 8; // Milliseconds of computing between looks at messages.
const COLLISIONS = 2000; // Most collisions of one call, about a millisecond.
const MARKED = 3; // Oscillations per second below which collisions are marked.

let library;
let speed = 300, playing = false, target = 0, clock = 0, isTurning = false;
let ahead = [], until = 0; // Settings that are still to come, and how far the run is replayed.
let leash = Infinity; // The oscillations of the run that this one follows.
let hash = { text: '', at: -1, when: 0 };
let state = { text: '', until: 0 };
let isStarted = false, isFrameOwed = false;
let rates = { since: 0, oscillations: 0, collisions: 0, perSecond: [0, 0] };

const turn = new MessageChannel();
turn.port1.onmessage = () => loop();

const numbers = () => new Float32Array(library.memory.buffer, library.numbers_at(), library.numbers_length()).slice();
const text = () => new TextDecoder().decode(new Uint8Array(library.memory.buffer, library.text_at(), library.text_length()));
const left = (write) => { write(); return numbers(); };
const told = (write) => { check(write()); return text(); };
function check(failed) { if (failed) throw new Error(text()); }

const isReplaying = () => library.oscillations() < until;

function start({ nut, seed, plan, at, isPlaying }) {
  check(library.start(seed, ...nut, ...plan[0].setting));
  ahead = plan.slice(1);
  until = Math.max(at, plan.at(-1).at);
  leash = Infinity;
  playing = isPlaying;
  state.until = 0;
  hash = { text: '', at: -1, when: 0 };
  begin();
  isStarted = true;
  if (isFrameOwed) frame();
}

function begin() {
  target = library.oscillations();
  clock = performance.now();
  rates = { since: clock, oscillations: target, collisions: library.collisions(), perSecond: rates.perSecond };
  nameState();
  if (!isTurning) { isTurning = true; loop(); }
}

function loop() {
  try {
    if (isReplaying()) { replay(); next(true); } else if (playing) { next(play()); } else { isTurning = false; }
  } catch (error) { fail(error); }
}

function next(isBehind) {
  if (isBehind) turn.port2.postMessage(0); else setTimeout(loop, 3);
}

// Runs to the end of the slice or to the goal, whichever comes first; ends at every whole oscillation on the way.
function runTo(goal, marks) {
  const end = performance.now() + SLICE;
  let now = library.oscillations();
  while (now < goal && performance.now() < end) {
    check(library.advance(Math.min(goal, Math.floor(now) + 1), COLLISIONS, marks ? 1 : 0));
    now = library.oscillations();
    if (!Number.isInteger(now)) continue;
    if (now === ahead[0]?.at) check(library.ask(...ahead.shift().setting));
    nameState();
  }
  measure();
  return now;
}

function play() {
  const now = performance.now(), passed = Math.min(now - clock, 100) / 1000;
  clock = now;
  const present = library.oscillations();
  // What could not be computed in time is let go.
  target = Math.min(Math.max(target, present) + speed * passed, present + Math.max(speed * 0.1, 1e-9));
  const goal = Math.min(speed === Infinity ? present + 1000 : target, leash);
  return runTo(goal, speed < MARKED) < goal || (speed === Infinity && goal < leash);
}

function replay() {
  if (runTo(until, false) >= until) { hash.when = 0; nameState(); begin(); postMessage({ arrived: true }); }
}

// Names the state by its hash, a few times a second, at whole oscillations.
function nameState() {
  const now = performance.now(), at = library.oscillations();
  if (!Number.isInteger(at) || (now - hash.when < 300 && hash.when > 0)) return;
  hash = { text: told(library.hash), at, when: now };
}

function measure() {
  const now = performance.now(), seconds = (now - rates.since) / 1000;
  if (seconds < 1) return;
  const [oscillations, collisions] = [library.oscillations(), library.collisions()];
  const perSecond = [(oscillations - rates.oscillations) / seconds, (collisions - rates.collisions) / seconds];
  rates = { since: now, oscillations, collisions, perSecond };
}

// The name of the state takes half a millisecond, so it is kept for a moment.
function stateName() {
  const now = performance.now();
  if (now > state.until) state = { text: told(library.state), until: now + 300 };
  return state.text;
}

function frame() {
  isFrameOwed = false;
  const disks = left(library.disks), flow = left(library.flow);
  const message = {
    disks, flow, marks: left(library.marks), samples: left(library.samples), numbers: left(library.numbers),
    oscillations: library.oscillations(), collisions: library.collisions(), state: stateName(), hash, perSecond: rates.perSecond,
    isReplaying: isReplaying(), until,
  };
  postMessage({ frame: message }, [disks.buffer, flow.buffer]);
}

function fail(error) {
  playing = isTurning = false;
  [ahead, until] = [[], 0];
  postMessage({ error: error instanceof WebAssembly.RuntimeError ? `the run broke off (${error.message})` : error.message });
}

const orders = {
  start,
  want(most = Infinity) { leash = most; if (isStarted) frame(); else isFrameOwed = true; },
  // Whoever changes a setting leaves the rest of a plan behind.
  ask(setting) {
    [ahead, until] = [[], 0];
    if (library.ask(...setting)) postMessage({ refused: text() }); else postMessage({ asked: Number(text()), setting });
  },
  // A change of the run that this one follows, and that has not come as far.
  follow(step) { if (step.at === library.oscillations()) check(library.ask(...step.setting)); else ahead.push(step); },
  speed(value) { speed = value; target = library.oscillations(); clock = performance.now(); },
  play(value) { playing = value; begin(); },
  step() { playing = false; check(library.step()); postMessage({ stepped: true }); },
  lines([larger, most]) { postMessage({ lines: left(() => check(library.lines(larger ? 1 : 0, most))), larger }); },
  hash() { if (Number.isInteger(library.oscillations())) { hash.when = 0; nameState(); } },
};

onmessage = async ({ data: [order, argument] }) => {
  try {
    if (order === 'load') {
      const bytes = await (await fetch('rolls.wasm')).arrayBuffer();
      library = (await WebAssembly.instantiate(bytes, {})).instance.exports;
      postMessage({ loaded: true });
    } else {
      orders[order](argument);
    }
  } catch (error) { fail(error); }
};
