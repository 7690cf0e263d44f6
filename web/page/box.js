// Draws the disks in their box, the mean flow, and collisions.

const WIDTH = 60, HEIGHT = 150, MARGIN = 1;
const COLUMNS = 10, ROWS = 25;
const INK = '#22272e', LEAST_FLOW = 0.12, ENOUGH = 0.08;

// From blue through a light gray to vermillion, both of Okabe and Ito, softened so that arrows stand out.
const SHADES = [-1, -0.75, -0.5, -0.25, 0, 0.25, 0.5, 0.75, 1].map((level) => {
  const end = level < 0 ? [0, 114, 178] : [213, 94, 0], share = 0.82 * Math.abs(level);
  return `rgb(${[222, 226, 231].map((gray, i) => Math.round(gray + share * (end[i] - gray))).join(' ')})`;
});

export function fit(canvas) {
  const scale = Math.min(window.devicePixelRatio || 1, 2);
  const [width, height] = [Math.round(canvas.clientWidth * scale), Math.round(canvas.clientHeight * scale)];
  if (canvas.width !== width || canvas.height !== height) { canvas.width = width; canvas.height = height; }
  const context = canvas.getContext('2d');
  context.setTransform(scale, 0, 0, scale, 0, 0);
  context.clearRect(0, 0, canvas.clientWidth, canvas.clientHeight);
  return context;
}

export class Box {
  #canvas; #marks = []; #dye = null; #before = null;
  fastest = 0; // Speed of the longest arrow.
  constructor(canvas) { this.#canvas = canvas; }

  // Dyes the disks by the half of the box in which they are.
  dye(disks) { this.#dye = Float32Array.from({ length: disks.length / 4 }, (_, i) => (disks[4 * i] < WIDTH / 2 ? -0.8 : 0.8)); }

  forget() { this.#marks = []; this.#dye = null; this.#before = null; }

  mark(marks, isStep) {
    const now = performance.now();
    if (isStep) this.#marks = [];
    for (let i = 0; i < marks.length; i += 5) this.#marks.push({ at: marks.subarray(i, i + 5), until: isStep ? Infinity : now + 350 });
    this.#marks = this.#marks.filter((mark) => mark.until > now).slice(-100);
  }

  clearSteps() { this.#marks = []; }

  draw({ disks, flow, numbers }, { color, arrows, isSlow }) {
    const context = fit(this.#canvas), unit = this.#canvas.clientWidth / (WIDTH + 2 * MARGIN);
    context.translate(MARGIN * unit, (HEIGHT + MARGIN) * unit);
    this.#walls(context, unit, numbers[6]);
    this.#disks(context, unit, disks, color);
    if (isSlow && unit > 4) this.#spokes(context, unit, disks);
    if (arrows) this.#arrows(context, unit, flow);
    this.#collisions(context, unit, disks);
    this.#before = disks;
  }

  #walls(context, unit, base) {
    context.fillStyle = '#8d96a0';
    context.fillRect(0, -base * unit, WIDTH * unit, (MARGIN + base) * unit);
    context.strokeStyle = '#b9c0c8';
    context.lineWidth = 1;
    context.strokeRect(-0.5, -HEIGHT * unit - 0.5, WIDTH * unit + 1, HEIGHT * unit + 1);
  }

  #shade(disks, i, color) {
    const value = color === 'dye' && this.#dye ? this.#dye[i] : color === 'rise' ? this.#rise(disks, i) : disks[4 * i + 3] / 2;
    return Math.round(4 + 4 * Math.max(-1, Math.min(1, value)));
  }

  #rise(disks, i) {
    return this.#before ? (disks[4 * i + 1] - this.#before[4 * i + 1]) / 3 : 0;
  }

  #disks(context, unit, disks, color) {
    const groups = SHADES.map(() => []);
    for (let i = 0; i < disks.length / 4; i += 1) groups[this.#shade(disks, i, color)].push(i);
    groups.forEach((group, shade) => {
      context.fillStyle = SHADES[shade];
      context.beginPath();
      for (const i of group) {
        const [x, y] = [disks[4 * i] * unit, -disks[4 * i + 1] * unit];
        context.moveTo(x + unit / 2, y);
        context.arc(x, y, unit / 2, 0, 2 * Math.PI);
      }
      context.fill();
    });
  }

  #spokes(context, unit, disks) {
    context.strokeStyle = '#69727d';
    context.lineWidth = 0.7;
    context.beginPath();
    for (let i = 0; i < disks.length; i += 4) {
      const [x, y, angle] = [disks[i] * unit, -disks[i + 1] * unit, -disks[i + 2]];
      context.moveTo(x, y);
      context.lineTo(x + Math.cos(angle) * unit * 0.45, y + Math.sin(angle) * unit * 0.45);
    }
    context.stroke();
  }

  #arrows(context, unit, flow) {
    let most = 0, fastest = LEAST_FLOW;
    for (let i = 0; i < flow.length; i += 3) most = Math.max(most, flow[i + 2]);
    const seen = [];
    for (let cell = 0; cell < COLUMNS * ROWS; cell += 1) {
      const [u, v, count] = flow.subarray(3 * cell, 3 * cell + 3);
      if (count < ENOUGH * most || count === 0) continue;
      seen.push([cell, u, v]);
      fastest = Math.max(fastest, Math.hypot(u, v));
    }
    this.fastest = fastest;
    const size = (WIDTH / COLUMNS) * unit;
    context.strokeStyle = context.fillStyle = INK;
    context.lineWidth = Math.max(1, unit * 0.28);
    for (const [cell, u, v] of seen) {
      const x = ((cell % COLUMNS) + 0.5) * size, y = -(Math.floor(cell / COLUMNS) + 0.5) * size;
      arrow(context, x, y, (u / fastest) * size * 1.15, (-v / fastest) * size * 1.15);
    }
  }

  #collisions(context, unit, disks) {
    const now = performance.now();
    for (const { at: [x, y, strength, first, second], until } of this.#marks) {
      context.globalAlpha = until === Infinity ? 1 : Math.max(0, Math.min(1, (until - now) / 350));
      context.strokeStyle = INK;
      context.lineWidth = 1.4;
      for (const disk of [first, second]) {
        if (disk < 0 || 4 * disk >= disks.length) continue;
        circle(context, disks[4 * disk] * unit, -disks[4 * disk + 1] * unit, unit / 2);
        context.stroke();
      }
      context.strokeStyle = '#e69f00';
      context.lineWidth = 2.2;
      circle(context, x * unit, -y * unit, 2 * unit);
      context.stroke();
      context.strokeStyle = INK;
      context.lineWidth = 1;
      context.fillStyle = '#e69f00';
      circle(context, x * unit, -y * unit, Math.min(unit, 2 + 2.5 * Math.sqrt(strength)));
      context.fill();
      context.stroke();
    }
    context.globalAlpha = 1;
  }
}

function circle(context, x, y, radius) {
  context.beginPath();
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
