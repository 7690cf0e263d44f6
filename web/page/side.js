// One of the runs that are shown: its worker, its box, and its last frame.

import { Box } from './box.js';

export class Side {
  frame = null; isStep = false;
  #worker; #isFresh = false; #onFrame;

  // Other messages of the worker go to the functions of their names.
  constructor(canvas, replies, onFrame) {
    this.box = new Box(canvas);
    this.#onFrame = onFrame;
    this.#worker = new Worker('worker.js');
    const own = { frame: (frame) => this.#take(frame), stepped: () => { this.isStep = true; } };
    this.#worker.onmessage = ({ data }) => { for (const name of Object.keys(data)) (own[name] ?? replies[name])?.(data[name], data); };
    this.#worker.onerror = (event) => replies.error(`it could not start: ${event.message}`);
    this.order('load');
  }

  order(name, argument) { this.#worker.postMessage([name, argument]); }

  start(run) {
    this.box.begin(run.scene);
    this.order('speed', run.speed);
    this.order('start', { nut: run.nut, seed: run.seed, plan: run.plan, at: run.at, isPlaying: run.isPlaying });
  }

  #take(frame) {
    [this.frame, this.#isFresh] = [frame, true];
    this.box.mark(frame.marks, this.isStep);
    if (frame.marks.length > 0) this.isStep = false;
    this.#onFrame(frame);
  }

  // Draws a frame that is new, and asks for the next one; the run gets no further than another that it follows.
  draw(options, most) {
    if (!this.#isFresh) return false;
    this.#isFresh = false;
    if (options.color !== 'dye') this.box.dye(this.frame.disks);
    this.box.draw(this.frame, options);
    this.order('want', most);
    return true;
  }

  end() { this.#worker.terminate(); }
}
