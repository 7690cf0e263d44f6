// The page: sliders, pictures, and the clock that asks the worker for frames.

const [BLUE, ORANGE, INK, QUIET, LINE] = ["#0072b2", "#d55e00", "#1f2933", "#5f6c7b", "#d9dee4"];
const [WIDTH, COLUMNS] = [60, 12];
const element = (id) => document.getElementById(id);

// Mean energy losses of the transitions, from Table I of the paper, and the largest inelasticity of each diagram.
const TABLE = [
  { gravity: 0.015625, most: 0.1, changes: [-0.047, -0.137, -0.147, -0.29] },
  { gravity: 0.002025, most: 0.25, changes: [-0.09, -0.351, -0.377, -0.614] },
];
const NAMES = ["0–1", "1–2 a", "1–2 b", "2–collapse"];

const logarithmic = (low, high) => ({
  from: (position) => Number((low * (high / low) ** position).toPrecision(3)),
  to: (value) => Math.log(value / low) / Math.log(high / low),
});
const linear = (low, high) => ({
  from: (position) => Number((low + position * (high - low)).toPrecision(3)),
  to: (value) => (value - low) / (high - low),
});

// The last notch of the speed.
const FASTEST = 2000;
const SLIDERS = {
  friction: { name: "friction κ", scale: logarithmic(0.003, 3), start: 0.03 },
  inelasticity: { name: "inelasticity q", scale: linear(0, 0.25), start: 0 },
  gravity: { name: "gravity g", scale: logarithmic(0.001, 0.2), start: 0.015625 },
  amplitude: { name: "amplitude A", scale: linear(0.02, 0.5), start: 0.1 },
  frequency: { name: "angular frequency ω", scale: linear(2, 30), start: 10 },
  speed: {
    name: "oscillations a second", scale: logarithmic(0.02, FASTEST), start: 300,
    shown: (value) => (value >= FASTEST ? "as many as it can" : value),
  },
};

// ---- settings, in the link

const settings = Object.fromEntries(Object.entries(SLIDERS).map(([name, { start }]) => [name, start]));
let [seed, until] = [1, Infinity];

function readLink() {
  const given = new URLSearchParams(location.hash.slice(1));
  for (const name of Object.keys(SLIDERS)) {
    const { scale } = SLIDERS[name];
    const value = Number(given.get(name));
    const within = given.has(name) && value >= scale.from(0) && value <= scale.from(1);
    if (within) settings[name] = value;
  }
  const whole = Number(given.get("seed"));
  if (given.has("seed") && Number.isInteger(whole) && whole >= 0 && whole < 2 ** 32) seed = whole;
  const end = Number(given.get("until"));
  if (given.has("until") && end > 0) until = end;
}

function link() {
  const parameters = new URLSearchParams({ ...settings, seed });
  return `${location.href.split("#")[0]}#${parameters}`;
}

// ---- what the worker told

const worker = new Worker("worker.js");
let state = null;
let history = [];
let marks = [];
let lines = [];
let waitingForFrame = true;
let paused = false;
let shownAt = performance.now();
const meter = { since: performance.now(), frames: 0, collisions: 0, oscillation: 0, busy: 0 };
const rates = { frames: 0, collisions: 0, oscillations: 0, busyCollisions: 0 };

const ask = (deed, rest = {}) => worker.postMessage({ deed, ...rest });

worker.onmessage = ({ data }) => {
  if (data.failure) {
    element("message").textContent = data.failure;
    paused = true;
    element("pause").textContent = "Go on";
    waitingForFrame = false;
    return;
  }
  if (data.lines) {
    lines = data.lines;
    return;
  }
  waitingForFrame = false;
  state = data;
  for (let k = 0; k < data.history.length; k += 3) history.push(data.history.subarray(k, k + 3));
  if (history.length > 6000) history = history.filter((_, k) => k % 2 === 0);
  const now = performance.now();
  for (let k = 0; k < data.marks.length; k += 2) marks.push({ x: data.marks[k], y: data.marks[k + 1], now });
  element("message").textContent = data.waiting ? "The base changes as soon as no grain is in its way." : "";
  if (data.oscillation >= until) pause(true);
  measureRates(now);
};

function measureRates(now) {
  meter.frames += 1;
  meter.busy += state.busy;
  const seconds = (now - meter.since) / 1000;
  if (seconds < 0.5) return;
  rates.frames = meter.frames / seconds;
  rates.collisions = (state.collisions - meter.collisions) / seconds;
  rates.oscillations = (state.oscillation - meter.oscillation) / seconds;
  rates.busyCollisions = meter.busy > 0 ? (state.collisions - meter.collisions) / (meter.busy / 1000) : 0;
  Object.assign(meter, { since: now, frames: 0, busy: 0, collisions: state.collisions, oscillation: state.oscillation });
}

// ---- the clock

function tick(now) {
  const elapsed = Math.min((now - shownAt) / 1000, 0.1);
  if (!waitingForFrame) {
    draw(now);
    shownAt = now;
    if (!paused) {
      waitingForFrame = true;
      const fast = settings.speed >= FASTEST;
      const wanted = fast ? Infinity : settings.speed * elapsed;
      const left = until - (state ? state.oscillation : 0);
      ask("frame", { oscillations: Math.min(wanted, left), milliseconds: fast ? 14 : 40, marks: settings.speed < 3 });
    }
  }
  requestAnimationFrame(tick);
}

function pause(value) {
  paused = value;
  element("pause").textContent = paused ? "Go on" : "Pause";
}

function restart() {
  [history, marks, state] = [[], [], null];
  Object.assign(meter, { since: performance.now(), frames: 0, busy: 0, collisions: 0, oscillation: 0 });
  ask("create", { seed, settings });
  waitingForFrame = true;
  ask("frame", { oscillations: 0, milliseconds: 0, marks: false });
}

// ---- what is seen in the flow

// Means of the last 300 samples, against twice the noise of a gas at rest.
function verdict() {
  const last = history.slice(-300);
  if (last.length < 100) return "too early to tell";
  const mean = (of) => last.reduce((sum, sample) => sum + of(sample), 0) / last.length;
  const [one, two] = [mean((sample) => sample[1]), mean((sample) => sample[2])];
  const seen = 0.05 * settings.amplitude * settings.frequency;
  if (two > Math.max(seen, Math.abs(one))) return "two rolls";
  if (Math.abs(one) > seen) return one > 0 ? "one roll, clockwise" : "one roll, counterclockwise";
  return "no clear roll";
}

// ---- pictures

function sheet(id) {
  const canvas = element(id);
  const [scale, { clientWidth: width, clientHeight: height }] = [window.devicePixelRatio || 1, canvas];
  if (canvas.width !== Math.round(width * scale) || canvas.height !== Math.round(height * scale)) {
    [canvas.width, canvas.height] = [Math.round(width * scale), Math.round(height * scale)];
  }
  const context = canvas.getContext("2d");
  context.setTransform(scale, 0, 0, scale, 0, 0);
  context.clearRect(0, 0, width, height);
  context.font = "12px system-ui, sans-serif";
  return { context, width, height };
}

function draw(now) {
  if (!state) return;
  drawBox(now);
  drawOrder();
  drawDiagram();
  element("verdict").textContent = verdict();
  element("oscillations").textContent = state.oscillation.toFixed(settings.speed < 3 ? 3 : 0);
  element("collisions").textContent = Math.round(rates.collisions).toLocaleString("en");
  element("rates").textContent = `${rates.oscillations.toFixed(rates.oscillations < 10 ? 2 : 0)}, ${rates.frames.toFixed(0)}`;
  element("hash").textContent = state.hash;
}

function drawBox(now) {
  const { context, width, height } = sheet("box");
  const unit = width / WIDTH;
  const y = (value) => height - 8 - value * unit;
  context.fillStyle = INK;
  context.fillRect(0, y(state.base), width, height);
  drawDisks(context, unit, y);
  drawFlow(context, unit, y);
  marks = marks.filter((mark) => now - mark.now < 500);
  for (const mark of marks) {
    const age = (now - mark.now) / 500;
    context.strokeStyle = `rgba(213, 94, 0, ${1 - age})`;
    context.lineWidth = 2;
    context.beginPath();
    context.arc(mark.x * unit, y(mark.y), unit * (0.3 + 1.1 * age), 0, 2 * Math.PI);
    context.stroke();
  }
}

// Grains in a few shades, one path for each, so that a thousand cost little.
function drawDisks(context, unit, y) {
  const { disks } = state;
  let square = 0;
  for (let k = 2; k < disks.length; k += 3) square += disks[k] * disks[k];
  const full = 2 * Math.sqrt((3 * square) / disks.length) || 1;
  const SHADES = 4;
  const shades = Array.from({ length: 2 * SHADES + 1 }, () => new Path2D());
  for (let k = 0; k < disks.length; k += 3) {
    const spin = Math.max(-1, Math.min(1, disks[k + 2] / full));
    const path = shades[Math.round(spin * SHADES) + SHADES];
    const [x, height] = [disks[k] * unit, y(disks[k + 1])];
    path.moveTo(x + 0.46 * unit, height);
    path.arc(x, height, 0.46 * unit, 0, 2 * Math.PI);
  }
  shades.forEach((path, index) => {
    const share = Math.abs(index - SHADES) / SHADES;
    const color = index < SHADES ? [0, 114, 178] : [213, 94, 0];
    const mixed = color.map((part, k) => Math.round([206, 211, 217][k] * (1 - share) + part * share));
    context.fillStyle = `rgb(${mixed})`;
    context.fill(path);
  });
}

function drawFlow(context, unit, y) {
  const { flow } = state;
  const side = WIDTH / COLUMNS;
  const cells = [];
  let most = 0;
  for (let k = 0; k < flow.length; k += 3) most = Math.max(most, flow[k]);
  let fastest = 0;
  for (let k = 0; k < flow.length / 3; k += 1) {
    const count = flow[3 * k];
    if (count < 0.06 * most || count < 20) continue;
    const velocity = [flow[3 * k + 1] / count, flow[3 * k + 2] / count];
    fastest = Math.max(fastest, Math.hypot(...velocity));
    cells.push({ x: (k % COLUMNS) + 0.5, y: Math.floor(k / COLUMNS) + 0.5, velocity });
  }
  // An arrow as long as a cell is the fastest one, but never less than a tenth of the speed of the base.
  const scale = side / Math.max(fastest, 0.1 * settings.amplitude * settings.frequency);
  context.strokeStyle = "rgba(31, 41, 51, 0.85)";
  context.fillStyle = context.strokeStyle;
  context.lineWidth = Math.max(1.4, 0.22 * unit);
  for (const cell of cells) {
    const [x, height] = [cell.x * side * unit, y(cell.y * side)];
    arrow(context, x, height, cell.velocity[0] * scale * unit, -cell.velocity[1] * scale * unit);
  }
}

function arrow(context, x, y, dx, dy) {
  const length = Math.hypot(dx, dy);
  if (length < 3) return;
  const [tipX, tipY, head] = [x + dx / 2, y + dy / 2, Math.min(9, 0.45 * length)];
  const [ux, uy] = [dx / length, dy / length];
  context.beginPath();
  context.moveTo(x - dx / 2, y - dy / 2);
  context.lineTo(tipX - ux * head, tipY - uy * head);
  context.stroke();
  context.beginPath();
  context.moveTo(tipX, tipY);
  context.lineTo(tipX - ux * head - 0.5 * uy * head, tipY - uy * head + 0.5 * ux * head);
  context.lineTo(tipX - ux * head + 0.5 * uy * head, tipY - uy * head - 0.5 * ux * head);
  context.fill();
}

// Draws the frame of a plot, and returns the maps from numbers to places.
function axes({ context, width, height }, low, high, ticks) {
  const [left, right, top, bottom] = [40, 10, 8, 22];
  const x = (share) => left + share * (width - left - right);
  const y = (value) => height - bottom - ((value - low) / (high - low)) * (height - top - bottom);
  context.strokeStyle = LINE;
  context.fillStyle = QUIET;
  context.lineWidth = 1;
  context.textAlign = "right";
  context.textBaseline = "middle";
  for (const tick of ticks) {
    context.beginPath();
    context.moveTo(x(0), y(tick));
    context.lineTo(x(1), y(tick));
    context.stroke();
    context.fillText(String(tick), left - 6, y(tick));
  }
  context.textAlign = "center";
  context.textBaseline = "top";
  return { x, y, under: height - bottom + 5 };
}

function drawOrder() {
  const plot = sheet("order");
  const { context } = plot;
  const most = Math.max(0.2, ...history.map((sample) => Math.max(Math.abs(sample[1]), Math.abs(sample[2]))));
  const step = most > 0.5 ? 0.5 : 0.1;
  const bound = Math.ceil(most / step) * step;
  const ticks = [-bound, 0, bound].map((tick) => Number(tick.toFixed(2)));
  const { x, y, under } = axes(plot, -bound, bound, ticks);
  const end = Math.max(100, state.oscillation);
  for (const share of [0, 0.5, 1]) {
    context.textAlign = share === 1 ? "right" : "center";
    context.fillText(Math.round(share * end).toLocaleString("en"), x(share), under);
  }
  context.lineWidth = 1.6;
  for (const [index, color] of [[1, BLUE], [2, ORANGE]]) {
    context.strokeStyle = color;
    context.beginPath();
    for (const sample of history) context.lineTo(x(sample[0] / end), y(sample[index]));
    context.stroke();
  }
}

const table = () => TABLE.reduce((best, one) => {
  const distance = ({ gravity }) => Math.abs(Math.log(gravity / settings.gravity));
  return distance(one) < distance(best) ? one : best;
});

function drawDiagram() {
  const plot = sheet("diagram");
  const { context } = plot;
  const { gravity, most } = table();
  const ticks = [0, most / 2, most].map((tick) => Number(tick.toFixed(3)));
  const { x, y, under } = axes(plot, 0, most, ticks);
  const place = (friction) => x(Math.log(friction / 0.003) / Math.log(1000));
  for (const tick of [0.003, 0.01, 0.03, 0.1, 0.3, 1, 3]) {
    context.textAlign = tick === 3 ? "right" : "center";
    context.fillText(String(tick), place(tick), under);
  }
  lines.forEach((line, index) => drawLine(context, line, NAMES[index], index, place, y, most));
  context.fillStyle = INK;
  context.textAlign = "left";
  context.fillText("q", 4, 4);
  const high = settings.inelasticity > most;
  context.fillStyle = ORANGE;
  context.beginPath();
  context.arc(place(settings.friction), y(Math.min(settings.inelasticity, most)), 6, 0, 2 * Math.PI);
  context.fill();
  context.strokeStyle = "#fff";
  context.lineWidth = 2;
  context.stroke();
  const nearest = Math.abs(gravity / settings.gravity - 1) < 0.01 ? "" : ", for the nearest of its two gravities";
  element("lines").textContent =
    `Friction κ and inelasticity q; lines: the paper’s transitions at g = ${gravity}${nearest}${high ? "; the point is above" : ""}`;
}

function drawLine(context, line, name, index, place, y, most) {
  context.strokeStyle = ["#8795a6", "#5b8fb0", "#5b8fb0", INK][index];
  context.setLineDash(index === 2 ? [5, 4] : []);
  context.lineWidth = 1.6;
  context.beginPath();
  let [down, named] = [false, null];
  for (let k = 0; k < line.length; k += 2) {
    const inside = line[k + 1] <= most;
    if (Number.isNaN(line[k]) || !inside) {
      down = false;
      continue;
    }
    const [px, py] = [place(line[k]), y(line[k + 1])];
    if (down) context.lineTo(px, py); else context.moveTo(px, py);
    down = true;
    named ??= [px, py];
  }
  context.stroke();
  context.setLineDash([]);
  if (named && index !== 2) {
    context.fillStyle = context.strokeStyle;
    context.textAlign = "left";
    context.textBaseline = "bottom";
    context.fillText(index === 1 ? "1–2" : name, named[0] + 3, named[1] - 2);
    context.textBaseline = "top";
  }
}

// ---- controls

function makeSliders() {
  for (const [name, { name: label, scale, shown }] of Object.entries(SLIDERS)) {
    const box = document.createElement("label");
    const [output, input] = [document.createElement("output"), document.createElement("input")];
    Object.assign(input, { type: "range", min: 0, max: 1, step: 0.001, id: name });
    const show = () => { output.textContent = shown ? shown(settings[name]) : settings[name]; };
    input.value = scale.to(settings[name]);
    show();
    input.addEventListener("input", () => {
      settings[name] = scale.from(Number(input.value));
      show();
      if (name === "gravity") askForLines();
      if (name !== "speed") ask("set", { settings });
    });
    box.append(label, output, input);
    element("sliders").append(box);
  }
}

const askForLines = () => ask("lines", { changes: table().changes });

function save() {
  const canvases = ["box", "order", "diagram"].map(element);
  const whole = document.createElement("canvas");
  const [box, order, diagram] = canvases;
  whole.width = box.width + Math.max(order.width, diagram.width) + 60;
  whole.height = Math.max(box.height, order.height + diagram.height + 20) + 80;
  const context = whole.getContext("2d");
  context.fillStyle = "#fff";
  context.fillRect(0, 0, whole.width, whole.height);
  context.fillStyle = INK;
  context.font = `${Math.round(box.width / 26)}px system-ui, sans-serif`;
  const { friction, inelasticity, gravity } = settings;
  const title = `κ = ${friction}, q = ${inelasticity}, g = ${gravity}, seed ${seed}, ${Math.round(state.oscillation)} oscillations: ${verdict()}`;
  context.fillText(title, 20, 42);
  context.drawImage(box, 20, 60);
  context.drawImage(order, box.width + 40, 60);
  context.drawImage(diagram, box.width + 40, 80 + order.height);
  const anchor = document.createElement("a");
  anchor.download = `rolls-friction-${friction}-inelasticity-${inelasticity}.png`;
  anchor.href = whole.toDataURL("image/png");
  anchor.click();
}

function makeButtons() {
  element("pause").onclick = () => {
    until = Infinity;
    element("message").textContent = "";
    pause(!paused);
  };
  element("step").onclick = () => {
    pause(true);
    ask("step");
  };
  element("restart").onclick = () => {
    until = Infinity;
    pause(false);
    restart();
  };
  element("seed").onchange = ({ target }) => {
    const value = Number(target.value);
    if (Number.isInteger(value) && value >= 0 && value < 2 ** 32) seed = value;
    target.value = seed;
    restart();
  };
  element("share").onclick = async () => {
    window.history.replaceState(null, "", link());
    const copied = await navigator.clipboard?.writeText(link()).then(() => true, () => false);
    element("message").textContent = copied ? "The link is copied; it has all settings." : "The link is in the address bar.";
  };
  element("save").onclick = save;
}

readLink();
element("seed").value = seed;
makeSliders();
makeButtons();
restart();
askForLines();
requestAnimationFrame(tick);

// For tests.
window.rolls = { settings, rates, verdict, state: () => state, isPaused: () => paused };
