// Plots two numbers over the last oscillations: the order parameters, or two heights; dashed those of the run beside.

import { fit, font, look } from './look.js';

const KEPT = 400, SAVED = 200000, LEFT = 38, RIGHT = 8, TOP = 8, BOTTOM = 32;

export class Order {
  #canvas; #scene; #samples = [[], []]; #all = [[], []]; #changes = []; #drawn = '';
  constructor(canvas) { this.#canvas = canvas; }

  get canvas() { return this.#canvas; }

  begin(scene) { this.#scene = scene; this.#samples = [[], []]; this.#all = [[], []]; this.#changes = []; this.#drawn = ''; }

  // Adds samples of the run, or of the one beside it.
  add(samples, side = 0) {
    for (let i = 0; i < samples.length; i += 4) {
      const sample = samples.subarray(i, i + 4);
      this.#samples[side].push(sample);
      if (this.#all[side].length < SAVED) this.#all[side].push(sample);
    }
    this.#samples[side] = this.#samples[side].slice(-KEPT);
  }

  // All samples as a table; run 0 is the one on the left.
  csv() {
    const columns = this.#scene.plot.columns;
    const rows = this.#all.flatMap((samples, run) => samples.map((sample) => [run, ...sample.subarray(0, columns.length - 1)].join()));
    return `${[columns.join(), ...rows].join('\n')}\n`;
  }

  changed(at) { if (this.#changes.at(-1) !== at) this.#changes.push(at); this.#changes = this.#changes.slice(-KEPT); }

  draw() {
    const last = this.#samples[0].at(-1)?.[0] ?? 0, { clientWidth: width, clientHeight: height } = this.#canvas;
    const drawn = [last, ...this.#samples.map((side) => side.length), this.#changes.length, width, look.scheme].join();
    if (drawn === this.#drawn) return;
    this.#drawn = drawn;
    const context = fit(this.#canvas), { plot } = this.#scene, first = Math.max(0, last - plot.window);
    const [seen, beside] = this.#samples.map((side) => side.filter((sample) => sample[0] >= first));
    const values = [...seen, ...beside].flatMap((sample) => [sample[1], sample[2]]);
    const [least, most] = [1.15 * Math.min(plot.least, ...values), 1.15 * Math.max(plot.most, ...values)];
    // The order parameters have a sign that means as much as its opposite.
    const low = plot.least < 0 ? Math.min(least, -most) : 0, high = plot.least < 0 ? -low : most;
    const x = (at) => LEFT + ((at - first) / plot.window) * (width - LEFT - RIGHT);
    const y = (value) => TOP + ((high - value) / (high - low)) * (height - TOP - BOTTOM);
    noise(context, seen, x, y);
    axes(context, { width, height, first, low, high, x, y, plot });
    context.strokeStyle = look.rule;
    for (const at of this.#changes.filter((at) => at >= first)) line(context, [[x(at), TOP], [x(at), height - BOTTOM]], 1);
    for (const [samples, dash] of [[seen, []], [beside, [4, 3]]]) {
      context.setLineDash(dash);
      [look.one, look.two].forEach((color, k) => {
        context.strokeStyle = color;
        line(context, samples.map((sample) => [x(sample[0]), y(sample[1 + k])]), 1.6);
      });
    }
    context.setLineDash([]);
  }
}

// The band of two standard deviations in which a gas at rest would be.
function noise(context, samples, x, y) {
  if (samples.length < 2) return;
  context.fillStyle = look.faint;
  context.beginPath();
  for (const sample of samples) context.lineTo(x(sample[0]), y(2 * sample[3]));
  for (const sample of samples.toReversed()) context.lineTo(x(sample[0]), y(-2 * sample[3]));
  context.fill();
}

function axes(context, { width, height, first, low, high, x, y, plot }) {
  context.font = font(11);
  context.fillStyle = look.quiet;
  context.textAlign = 'right';
  context.textBaseline = 'middle';
  const step = plot.steps.find((step) => (high - low) / step < 9) ?? plot.steps.at(-1);
  for (let count = Math.ceil(low / step); count * step <= high; count += 1) {
    const value = count * step;
    context.strokeStyle = count === 0 ? look.rule : look.faint;
    line(context, [[LEFT, y(value)], [width - RIGHT, y(value)]], 1);
    context.fillText(value.toFixed(plot.digits).replace('-', '−'), LEFT - 5, y(value));
  }
  context.textAlign = 'center';
  context.textBaseline = 'alphabetic';
  const stride = width < 260 ? 2 * plot.stride : plot.stride;
  for (let at = Math.ceil(first / stride) * stride; at <= first + plot.window; at += stride) {
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
