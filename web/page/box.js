// Draws the disks in their box, the mean flow, and collisions.

import { fit, look } from './look.js';

const MARGIN = 1, NUMBERS = 5; // Numbers of a disk: place, angle, angular velocity, radius.
const LARGE = 0.6; // Radius from which a disk is drawn with a rim.

export class Box {
  #canvas; #scene; #marks = []; #dye = null; #before = null;
  fastest = 0; // Speed of the longest arrow.
  constructor(canvas) { this.#canvas = canvas; }

  get canvas() { return this.#canvas; }

  // Dyes the disks by the half of the box in which they are.
  dye(disks) { this.#dye = Float32Array.from({ length: disks.length / NUMBERS }, (_, i) => (disks[NUMBERS * i] < this.#scene.width / 2 ? -0.8 : 0.8)); }

  begin(scene) { this.#scene = scene; this.#marks = []; this.#dye = null; this.#before = null; }

  mark(marks, isStep) {
    const now = performance.now();
    if (isStep) this.#marks = [];
    for (let i = 0; i < marks.length; i += 5) this.#marks.push({ at: marks.subarray(i, i + 5), until: isStep ? Infinity : now + 350 });
    this.#marks = this.#marks.filter((mark) => mark.until > now).slice(-100);
  }

  clearSteps() { this.#marks = []; }

  draw({ disks, flow, numbers }, { color, arrows, isSlow }) {
    const { width, height } = this.#scene, context = fit(this.#canvas), unit = this.#canvas.clientWidth / (width + 2 * MARGIN);
    context.translate(MARGIN * unit, (height + MARGIN) * unit);
    this.#walls(context, unit, numbers[3]);
    this.#disks(context, unit, disks, color);
    if (isSlow && unit > 4) this.#spokes(context, unit, disks);
    if (arrows) this.#arrows(context, unit, flow);
    this.#collisions(context, unit, disks);
    this.#before = disks;
  }

  #walls(context, unit, base) {
    const { width, height } = this.#scene;
    context.fillStyle = look.wall;
    context.fillRect(0, -base * unit, width * unit, (MARGIN + Math.max(base, 0)) * unit);
    context.strokeStyle = look.rule;
    context.lineWidth = 1;
    context.strokeRect(-0.5, -height * unit - 0.5, width * unit + 1, height * unit + 1);
  }

  #shade(disks, i, color) {
    const value = color === 'dye' && this.#dye ? this.#dye[i] : color === 'rise' ? this.#rise(disks, i) : disks[NUMBERS * i + 3] / 2;
    return Math.round(4 + 4 * Math.max(-1, Math.min(1, value)));
  }

  #rise(disks, i) {
    return this.#before ? (disks[NUMBERS * i + 1] - this.#before[NUMBERS * i + 1]) / 3 : 0;
  }

  #disks(context, unit, disks, color) {
    const groups = look.shades.map(() => []);
    for (let i = 0; i < disks.length / NUMBERS; i += 1) groups[this.#shade(disks, i, color)].push(NUMBERS * i);
    const path = (at) => circle(context, disks[at] * unit, -disks[at + 1] * unit, disks[at + 4] * unit);
    groups.forEach((group, shade) => {
      context.fillStyle = look.shades[shade];
      context.beginPath();
      group.forEach(path);
      context.fill();
    });
    context.strokeStyle = look.ink;
    context.lineWidth = 1.5;
    context.beginPath();
    for (let at = 0; at < disks.length; at += NUMBERS) if (disks[at + 4] > LARGE) path(at);
    context.stroke();
  }

  #spokes(context, unit, disks) {
    context.strokeStyle = look.quiet;
    context.lineWidth = 0.7;
    context.beginPath();
    for (let i = 0; i < disks.length; i += NUMBERS) {
      const [x, y, angle, length] = [disks[i] * unit, -disks[i + 1] * unit, -disks[i + 2], 0.9 * disks[i + 4] * unit];
      context.moveTo(x, y);
      context.lineTo(x + Math.cos(angle) * length, y + Math.sin(angle) * length);
    }
    context.stroke();
  }

  #arrows(context, unit, flow) {
    const { columns, rows, width, leastFlow, enough } = this.#scene;
    let most = 0, fastest = leastFlow;
    for (let i = 0; i < flow.length; i += 3) most = Math.max(most, flow[i + 2]);
    const seen = [];
    for (let cell = 0; cell < columns * rows; cell += 1) {
      const [u, v, count] = flow.subarray(3 * cell, 3 * cell + 3);
      if (count < enough * most || count === 0) continue;
      seen.push([cell, u, v]);
      fastest = Math.max(fastest, Math.hypot(u, v));
    }
    this.fastest = fastest;
    const size = (width / columns) * unit;
    context.strokeStyle = context.fillStyle = look.ink;
    context.lineWidth = Math.max(1, Math.min(unit * 0.28, 1.8));
    for (const [cell, u, v] of seen) {
      const x = ((cell % columns) + 0.5) * size, y = -(Math.floor(cell / columns) + 0.5) * size;
      arrow(context, x, y, (u / fastest) * size * 1.15, (-v / fastest) * size * 1.15);
    }
  }

  #collisions(context, unit, disks) {
    const now = performance.now();
    for (const { at: [x, y, strength, first, second], until } of this.#marks) {
      context.globalAlpha = until === Infinity ? 1 : Math.max(0, Math.min(1, (until - now) / 350));
      context.strokeStyle = look.ink;
      context.lineWidth = 1.4;
      for (const at of [NUMBERS * first, NUMBERS * second]) {
        if (at < 0 || at >= disks.length) continue;
        context.beginPath();
        circle(context, disks[at] * unit, -disks[at + 1] * unit, disks[at + 4] * unit);
        context.stroke();
      }
      context.strokeStyle = look.mark;
      context.lineWidth = 2.2;
      context.beginPath();
      circle(context, x * unit, -y * unit, 2 * unit);
      context.stroke();
      context.strokeStyle = look.ink;
      context.lineWidth = 1;
      context.fillStyle = look.mark;
      context.beginPath();
      circle(context, x * unit, -y * unit, Math.min(unit, 2 + 2.5 * Math.sqrt(strength)));
      context.fill();
      context.stroke();
    }
    context.globalAlpha = 1;
  }
}

function circle(context, x, y, radius) {
  context.moveTo(x + radius, y);
  context.arc(x, y, radius, 0, 2 * Math.PI);
}

function arrow(context, x, y, u, v) {
  const length = Math.hypot(u, v);
  if (length < 2) return;
  const [ex, ey] = [u / length, v / length], head = Math.min(length * 0.45, 7);
  const [tx, ty] = [x + u / 2, y + v / 2], [bx, by] = [tx - head * ex, ty - head * ey];
  context.beginPath();
  context.moveTo(x - u / 2, y - v / 2);
  context.lineTo(bx, by);
  context.stroke();
  context.beginPath();
  context.moveTo(tx, ty);
  context.lineTo(bx - 0.5 * head * ey, by + 0.5 * head * ex);
  context.lineTo(bx + 0.5 * head * ey, by - 0.5 * head * ex);
  context.fill();
}
