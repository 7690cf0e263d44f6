// The diagram of states in the plane of friction and inelasticity: areas of recorded runs, the paper's lines, the point of this run.

import { fit, font, look } from './look.js';

const FRICTIONS = [0.004, 4], LEFT = 44, RIGHT = 10, TOP = 8, BOTTOM = 34;
const AREAS = { 'no roll': 'none', conductive: 'none', 'one roll': 'one', 'coexistence of one roll and two': 'both', 'two rolls': 'two', collapsed: 'collapse' };
const LINES = [['one', '0–1'], ['change', '1–2 (a)'], ['two', '1–2 (b)'], ['collapse', '2–collapse']];

// Gravities of the recorded runs at Aω = 1, and the largest inelasticity of their diagrams.
const LARGER = { gravity: '0.015625', most: 0.08 }, SMALLER = { gravity: '0.002025', most: 0.24 };

// Only g/(Aω)² counts: a faster base with more gravity is the same run, seen in a shorter unit of time.
export const reducedGravity = ([, , gravity, amplitude, frequency]) => gravity / (amplitude * frequency) ** 2;
export const setOf = (values) => (reducedGravity(values) > Math.sqrt(LARGER.gravity * SMALLER.gravity) ? LARGER : SMALLER);
export const isLarger = (set) => set === LARGER;

export class Diagram {
  #canvas; #back = null; #cells = []; #lines = []; #trail = []; #drawn = '';
  set = LARGER;

  constructor(canvas, onMove) {
    this.#canvas = canvas;
    const move = (event) => { if (event.buttons) onMove(...this.#value(event.offsetX, event.offsetY)); };
    canvas.addEventListener('pointerdown', (event) => { canvas.setPointerCapture(event.pointerId); move(event); });
    canvas.addEventListener('pointermove', move);
  }

  get canvas() { return this.#canvas; }

  // Takes the table of recorded runs and the lines for one gravity.
  async load(set, lines) {
    const table = await (await fetch(`states-${set.gravity}.csv`)).text();
    this.set = set;
    this.#lines = lines;
    this.#cells = cells(table);
    this.#drawn = '';
  }

  begin() { this.#trail = []; }

  // Draws the points of the runs: of the one with its trail, and of the one beside it.
  draw([friction, inelasticity], beside) {
    const { clientWidth: width, clientHeight: height } = this.#canvas, drawn = `${width} ${height} ${look.scheme}`;
    const context = fit(this.#canvas);
    if (drawn !== this.#drawn) { this.#drawn = drawn; this.#back = this.#background(width, height, this.#canvas.width / width); }
    context.drawImage(this.#back, 0, 0, width, height);
    const last = this.#trail.at(-1);
    if (last?.[0] !== friction || last?.[1] !== inelasticity) this.#trail = [...this.#trail, [friction, inelasticity]].slice(-60);
    context.strokeStyle = look.ink;
    context.globalAlpha = 0.45;
    context.save();
    context.rect(LEFT, TOP, width - LEFT - RIGHT, height - TOP - BOTTOM);
    context.clip();
    this.#path(context, this.#trail, 1.2);
    context.restore();
    context.globalAlpha = 1;
    if (beside) this.#point(context, beside, look.ink);
    this.#point(context, [friction, inelasticity], look.paper);
  }

  // A circle, or at the frame a triangle that points to where the point is, outside.
  #point(context, [friction, inelasticity], fill) {
    const { clientWidth: width, clientHeight: height } = this.#canvas, [x, y] = this.#place(friction, inelasticity);
    const [px, py] = [Math.max(LEFT, Math.min(width - RIGHT, x)), Math.max(TOP, Math.min(height - BOTTOM, y))];
    Object.assign(context, { fillStyle: fill, strokeStyle: look.ink, lineWidth: 3, lineJoin: 'round' });
    context.beginPath();
    if (px === x && py === y) {
      context.arc(x, y, 6.5, 0, 2 * Math.PI);
    } else {
      const way = Math.atan2(Math.sign(y - py), Math.sign(x - px));
      for (const turn of [0, 2.2, -2.2]) context.lineTo(px + 9 * (Math.cos(way + turn) - Math.cos(way)), py + 9 * (Math.sin(way + turn) - Math.sin(way)));
      context.closePath();
    }
    context.stroke();
    context.fill();
    if (px === x && py === y) return;
    Object.assign(context, { font: font(11, 600), fillStyle: look.ink, strokeStyle: look.halo, textAlign: x < width / 2 ? 'left' : 'right' });
    const at = ['outside', px + (x < width / 2 ? 18 : -18), Math.max(py, TOP + 12) + (py > height / 2 ? -8 : 4)];
    context.strokeText(...at);
    context.fillText(...at);
  }

  #place(friction, inelasticity) {
    const share = Math.log(Math.max(friction, 1e-9) / FRICTIONS[0]) / Math.log(FRICTIONS[1] / FRICTIONS[0]);
    const { clientWidth: width, clientHeight: height } = this.#canvas;
    return [LEFT + share * (width - LEFT - RIGHT), height - BOTTOM - (inelasticity / this.set.most) * (height - TOP - BOTTOM)];
  }

  #value(x, y) {
    const { clientWidth: width, clientHeight: height } = this.#canvas;
    const across = Math.max(0, Math.min(1, (x - LEFT) / (width - LEFT - RIGHT)));
    const up = Math.max(0, Math.min(1, (height - BOTTOM - y) / (height - TOP - BOTTOM)));
    return [FRICTIONS[0] * (FRICTIONS[1] / FRICTIONS[0]) ** across, up * this.set.most];
  }

  #path(context, points, width) {
    context.lineWidth = width;
    context.beginPath();
    for (const [friction, q] of points) context.lineTo(...this.#place(friction, q));
    context.stroke();
  }

  #background(width, height, scale) {
    const back = document.createElement('canvas');
    [back.width, back.height] = [width * scale, height * scale];
    const context = back.getContext('2d');
    context.scale(scale, scale);
    const hatch = context.createPattern(hatching(), 'repeat');
    for (const { left, right, low, high, state } of this.#cells) {
      const [x0, y0] = this.#place(left, low), [x1, y1] = this.#place(right, high), area = AREAS[state];
      for (const fill of [look[`area-${area}`] ?? look.paper, ...(area === 'both' ? [hatch] : [])]) {
        context.fillStyle = fill;
        context.fillRect(x0, y1, x1 - x0 + 0.6, y0 - y1 + 0.6);
      }
    }
    this.#isoLines(context);
    this.#axes(context, width, height);
    return back;
  }

  #isoLines(context) {
    const points = this.#lines, pieces = [[]];
    for (let i = 0; i < points.length; i += 3) {
      if (Number.isNaN(points[i])) pieces.push([]); else pieces.at(-1).push([points[i], points[i + 1], points[i + 2]]);
    }
    const named = new Set();
    for (const piece of pieces.filter((piece) => piece.length > 1)) {
      const [color, name] = LINES[piece[0][0]];
      context.strokeStyle = context.fillStyle = look[color];
      this.#path(context, piece.map(([, friction, q]) => [friction, q]), 1.8);
      // The two lines from one roll to two nearly coincide, and share a name.
      if (named.has(name) || name === '1–2 (a)') continue;
      named.add(name);
      const [x, y] = this.#place(piece[0][1], piece[0][2]);
      context.font = font(11, 600);
      const at = [name.replace(' (b)', ''), x + 6, y - 5 < TOP + 14 ? y + 28 : y - 5];
      Object.assign(context, { strokeStyle: look.halo, lineWidth: 3, lineJoin: 'round' });
      context.strokeText(...at);
      context.fillText(...at);
    }
  }

  #axes(context, width, height) {
    context.strokeStyle = look.wall;
    context.lineWidth = 1;
    context.strokeRect(LEFT + 0.5, TOP + 0.5, width - LEFT - RIGHT - 1, height - TOP - BOTTOM - 1);
    context.font = font(11);
    context.fillStyle = look.quiet;
    context.textAlign = 'center';
    for (const friction of [0.01, 0.03, 0.1, 0.3, 1, 3]) context.fillText(String(friction), this.#place(friction, 0)[0], height - BOTTOM + 14);
    context.fillText('friction κ', LEFT + (width - LEFT - RIGHT) / 2, height - 5);
    context.textAlign = 'right';
    for (let step = 0; step <= 4; step += 1) {
      const q = (step * this.set.most) / 4;
      context.fillText(q.toFixed(2), LEFT - 5, this.#place(1, q)[1] + 4);
    }
    context.save();
    context.translate(11, TOP + (height - TOP - BOTTOM) / 2);
    context.rotate(-Math.PI / 2);
    context.textAlign = 'center';
    context.fillText('inelasticity q', 0, 0);
    context.restore();
  }
}

// Slanted lines over what comes in turn, so that color alone does not tell it.
function hatching() {
  const tile = document.createElement('canvas');
  tile.width = tile.height = 6;
  const context = tile.getContext('2d');
  context.strokeStyle = look.hatch;
  context.lineWidth = 1.4;
  for (const shift of [-6, 0, 6]) { context.moveTo(shift, 6); context.lineTo(shift + 6, 0); }
  context.stroke();
  return tile;
}

// Makes a rectangle of each run, reaching halfway to its neighbors.
function cells(table) {
  const runs = table.trim().split('\n').slice(1).map((row) => row.split(',')).map(([friction, q, state]) => ({ friction: Number(friction), q: Number(q), state }));
  const frictions = edges(runs.map((run) => run.friction), (a, b) => Math.sqrt(a * b));
  const inelasticities = edges(runs.map((run) => run.q), (a, b) => (a + b) / 2);
  return runs.map(({ friction, q, state }) => {
    const [[left, right], [low, high]] = [frictions.get(friction), inelasticities.get(q)];
    return { left, right, low, high, state };
  });
}

function edges(values, middle) {
  const sorted = [...new Set(values)].sort((a, b) => a - b);
  return new Map(sorted.map((value, i) => [value, [i === 0 ? value : middle(sorted[i - 1], value),
    i === sorted.length - 1 ? value : middle(value, sorted[i + 1])]]));
}
