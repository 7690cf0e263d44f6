// The diagram of states in the plane of friction and inelasticity: areas of recorded runs, the paper's lines, the point of this run.

import { fit } from './box.js';

const FRICTIONS = [0.004, 4], LEFT = 44, RIGHT = 10, TOP = 8, BOTTOM = 34, INK = '#22272e', QUIET = '#69727d';
const AREAS = { 'no roll': '#e6e9ec', conductive: '#e6e9ec', 'one roll': '#b3d1e5', 'coexistence of one roll and two': '#ecccdc', 'two rolls': '#f3ceb0', collapsed: '#c3c6ca' };
const LINES = [['#0072b2', '0–1'], ['#a85585', '1–2 (a)'], ['#d55e00', '1–2 (b)'], ['#222', '2–collapse']];

// Gravities of the recorded runs, and the largest inelasticity of their diagrams.
export const LARGER = { gravity: '0.015625', most: 0.08 }, SMALLER = { gravity: '0.002025', most: 0.24 };

export class Diagram {
  #canvas; #back = null; #cells = []; #lines = []; #trail = []; #size = '';
  set = LARGER;

  constructor(canvas, onMove) {
    this.#canvas = canvas;
    const move = (event) => { if (event.buttons) onMove(...this.#value(event.offsetX, event.offsetY)); };
    canvas.addEventListener('pointerdown', (event) => { canvas.setPointerCapture(event.pointerId); move(event); });
    canvas.addEventListener('pointermove', move);
  }

  // Takes the table of recorded runs and the lines for one gravity.
  async load(set, lines) {
    const table = await (await fetch(`states-${set.gravity}.csv`)).text();
    this.set = set;
    this.#lines = lines;
    this.#cells = cells(table);
    this.#size = '';
  }

  forget() { this.#trail = []; }

  draw(friction, inelasticity) {
    const { clientWidth: width, clientHeight: height } = this.#canvas, size = `${width} ${height}`;
    const context = fit(this.#canvas);
    if (size !== this.#size) { this.#size = size; this.#back = this.#background(width, height, this.#canvas.width / width); }
    context.drawImage(this.#back, 0, 0, width, height);
    const last = this.#trail.at(-1);
    if (last?.[0] !== friction || last?.[1] !== inelasticity) this.#trail = [...this.#trail, [friction, inelasticity]].slice(-60);
    context.strokeStyle = INK;
    context.globalAlpha = 0.45;
    this.#path(context, this.#trail, 1.2);
    context.globalAlpha = 1;
    const [x, y] = this.#place(friction, inelasticity);
    context.beginPath();
    context.arc(Math.max(LEFT, Math.min(width - RIGHT, x)), Math.max(TOP, y), 6.5, 0, 2 * Math.PI);
    context.fillStyle = '#fff';
    context.fill();
    context.lineWidth = 3.5;
    context.stroke();
  }

  #place(friction, inelasticity) {
    const share = Math.log(friction / FRICTIONS[0]) / Math.log(FRICTIONS[1] / FRICTIONS[0]);
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
    for (const { left, right, low, high, state } of this.#cells) {
      const [x0, y0] = this.#place(left, low), [x1, y1] = this.#place(right, high);
      context.fillStyle = AREAS[state] ?? '#fff';
      context.fillRect(x0, y1, x1 - x0 + 0.6, y0 - y1 + 0.6);
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
      context.strokeStyle = context.fillStyle = color;
      this.#path(context, piece.map(([, friction, q]) => [friction, q]), 1.8);
      // The two lines from one roll to two nearly coincide, and share a name.
      if (named.has(name) || name === '1–2 (a)') continue;
      named.add(name);
      const [x, y] = this.#place(piece[0][1], piece[0][2]);
      context.font = '600 11px system-ui, sans-serif';
      const at = [name.replace(' (b)', ''), x + 6, y - 5 < TOP + 14 ? y + 28 : y - 5];
      Object.assign(context, { strokeStyle: 'rgb(255 255 255 / 70%)', lineWidth: 3, lineJoin: 'round' });
      context.strokeText(...at);
      context.fillText(...at);
    }
  }

  #axes(context, width, height) {
    context.strokeStyle = '#8d96a0';
    context.lineWidth = 1;
    context.strokeRect(LEFT + 0.5, TOP + 0.5, width - LEFT - RIGHT - 1, height - TOP - BOTTOM - 1);
    context.font = '11px system-ui, sans-serif';
    context.fillStyle = QUIET;
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

// Makes a rectangle of each run on the way up, reaching halfway to its neighbors.
function cells(table) {
  const [header, ...rows] = table.trim().split('\n').map((row) => row.split(','));
  const at = (name) => header.indexOf(name);
  const runs = rows.filter((row) => row[at('leg')] === 'up').map((row) => ({ friction: Number(row[at('friction')]),
    q: Number(row[at('inelasticity')]), state: row[at('regime')] }));
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
