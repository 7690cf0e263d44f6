// Plots the order parameters over the last oscillations.

import { fit } from './box.js';

const WINDOW = 3000, KEPT = 400, ONE = '#0072b2', TWO = '#d55e00', QUIET = '#69727d';
const LEFT = 38, RIGHT = 8, TOP = 8, BOTTOM = 32;

export class Order {
  #canvas; #samples = []; #changes = []; #drawn = '';
  constructor(canvas) { this.#canvas = canvas; }

  forget() { this.#samples = []; this.#changes = []; this.#drawn = ''; }

  add(samples) {
    for (let i = 0; i < samples.length; i += 4) this.#samples.push(samples.subarray(i, i + 4));
    this.#samples = this.#samples.slice(-KEPT);
  }

  changed(at) { if (this.#changes.at(-1) !== at) this.#changes.push(at); this.#changes = this.#changes.slice(-KEPT); }

  draw() {
    const last = this.#samples.at(-1)?.[0] ?? 0;
    const drawn = `${last} ${this.#samples.length} ${this.#changes.length} ${this.#canvas.clientWidth}`;
    if (drawn === this.#drawn) return;
    this.#drawn = drawn;
    const context = fit(this.#canvas), { clientWidth: width, clientHeight: height } = this.#canvas;
    const first = Math.max(0, last - WINDOW);
    const seen = this.#samples.filter((sample) => sample[0] >= first);
    const most = 1.15 * Math.max(0.13, ...seen.map((sample) => Math.max(Math.abs(sample[1]), Math.abs(sample[2]))));
    const x = (at) => LEFT + ((at - first) / WINDOW) * (width - LEFT - RIGHT);
    const y = (value) => TOP + (0.5 - (0.5 * value) / most) * (height - TOP - BOTTOM);
    noise(context, seen, x, y);
    axes(context, { width, height, first, most, x, y });
    context.strokeStyle = '#b9c0c8';
    for (const at of this.#changes.filter((at) => at >= first)) line(context, [[x(at), TOP], [x(at), height - BOTTOM]], 1);
    context.strokeStyle = ONE;
    line(context, seen.map((sample) => [x(sample[0]), y(sample[1])]), 1.6);
    context.strokeStyle = TWO;
    line(context, seen.map((sample) => [x(sample[0]), y(sample[2])]), 1.6);
  }
}

// The band of two standard deviations in which a gas at rest would be.
function noise(context, samples, x, y) {
  if (samples.length < 2) return;
  context.fillStyle = '#eceef1';
  context.beginPath();
  for (const sample of samples) context.lineTo(x(sample[0]), y(2 * sample[3]));
  for (const sample of samples.toReversed()) context.lineTo(x(sample[0]), y(-2 * sample[3]));
  context.fill();
}

function axes(context, { width, height, first, most, x, y }) {
  context.font = '11px system-ui, sans-serif';
  context.fillStyle = QUIET;
  context.textAlign = 'right';
  context.textBaseline = 'middle';
  const step = most > 0.5 ? 0.25 : most > 0.22 ? 0.1 : 0.05;
  for (let value = -Math.floor(most / step) * step; value <= most; value += step) {
    context.strokeStyle = Math.abs(value) < 1e-9 ? '#b9c0c8' : '#eceef1';
    line(context, [[LEFT, y(value)], [width - RIGHT, y(value)]], 1);
    context.fillText(value.toFixed(2).replace('-', '−').replace('−0.00', '0.00'), LEFT - 5, y(value));
  }
  context.textAlign = 'center';
  context.textBaseline = 'alphabetic';
  const stride = width < 260 ? 2000 : 1000;
  for (let at = Math.ceil(first / stride) * stride; at <= first + WINDOW; at += stride) {
    if (x(at) < width - 14) context.fillText(String(at), x(at), height - BOTTOM + 14);
  }
  context.fillText('oscillations', LEFT + (width - LEFT - RIGHT) / 2, height - 4);
}

function line(context, points, width) {
  context.lineWidth = width;
  context.beginPath();
  for (const [x, y] of points) context.lineTo(x, y);
  context.stroke();
}
