// Sliders, and the address that holds a run: scene, seed, plan, oscillations, and what is beside it.

import { NUT, ROLLS } from './scenes.js';

const PRESSED = 0.005; // Share of a slider by which a key moves it at least.
const KEYS = { ArrowRight: 1, ArrowUp: 1, ArrowLeft: -1, ArrowDown: -1, PageUp: 10, PageDown: -10 };

const low = 0.01, high = 2000;
export const speedOf = (position) => (position >= 1000 ? Infinity : Number((low * (high / low) ** (position / 1000)).toPrecision(2)));
export const positionOf = (speed) => (speed === Infinity ? 1000 : Math.min(999, Math.round((1000 * Math.log(speed / low)) / Math.log(high / low))));

// What is wrong with a number that was typed, or nothing.
export function refused(input, { symbol, least, most }) {
  const value = Number(input.value);
  if (input.value !== '' && value >= least && value <= most) return '';
  return `${symbol} = ${input.value || 'nothing'} was refused: a number from ${least} to ${most} is needed.`;
}

const shareOf = (setting, value) => Math.max(0, Math.min(1, setting.from(Math.max(value, 1e-12))));

// The next value of the slider in this direction that rounding does not take back.
function stepped(setting, value, way) {
  const share = shareOf(setting, value);
  for (let count = 1; count <= 1 / PRESSED; count += 1) {
    const next = setting.round(setting.to(Math.max(0, Math.min(1, share + way * count * PRESSED))));
    if ((next - value) * way > 0) return next;
  }
  return value;
}

export class Sliders {
  values = [];
  #parent; #settings = []; #rows = []; #onChange; #say;

  constructor(parent, onChange, say) { [this.#parent, this.#onChange, this.#say] = [parent, onChange, say]; }

  // Makes the sliders of a scene.
  make({ settings }) {
    if (settings === this.#settings) return;
    this.#settings = settings;
    this.#parent.replaceChildren();
    this.#rows = settings.map((setting, i) => this.#row(setting, i));
  }

  #row(setting, i) {
    const row = document.createElement('div');
    row.className = 'slider';
    row.innerHTML = `<label for="value-${i}"><b>${setting.symbol}</b> ${setting.name}</label>
      <input id="value-${i}" type="number" step="any" min="${setting.least}" max="${setting.most}">
      <input id="slider-${i}" type="range" min="0" max="1" step="any" aria-label="${setting.name}">`;
    this.#parent.append(row);
    const [number, range] = row.querySelectorAll('input');
    const take = (value) => { this.#take(i, value); this.#onChange(); };
    range.addEventListener('input', () => take(setting.round(setting.to(Number(range.value)))));
    range.addEventListener('keydown', (event) => {
      if (!KEYS[event.key]) return;
      event.preventDefault();
      take(stepped(setting, this.values[i], KEYS[event.key]));
    });
    number.addEventListener('change', () => {
      const fault = refused(number, setting);
      this.#say(fault);
      if (fault) this.#take(i, this.values[i]); else take(Number(number.value));
    });
    return { number, range };
  }

  show(values) { values.forEach((value, i) => this.#take(i, value)); }

  #take(i, value) {
    this.values[i] = value;
    const { number, range } = this.#rows[i];
    number.value = String(value);
    range.value = String(shareOf(this.#settings[i], value));
    range.setAttribute('aria-valuetext', String(value));
  }
}

export function toAddress({ nut, seed, plan, at, speed, isPlaying, beside }) {
  const steps = plan.map((step) => `${step.at}:${step.setting.join(',')}`).join(';');
  const parts = [nut[0] ? `nut=${nut}` : '', `seed=${seed}`, `plan=${steps}`, `at=${at}`, beside ? `beside=${beside.setting}:${beside.value}` : '',
    `speed=${speed === Infinity ? 'max' : speed}`, isPlaying ? '' : 'paused'];
  return `#${parts.filter(Boolean).join('&')}`;
}

// Reads an address; what is missing in it is as at the start, and what is wrong in it is told.
export function fromAddress(address) {
  const given = new Map(address.replace(/^#/, '').split('&').map((part) => part.split('=')));
  const natural = (text, otherwise) => (/^\d{1,10}$/.test(text ?? '') && Number(text) < 2 ** 32 ? Number(text) : otherwise);
  const numbers = (text) => (text ?? '').split(',').map((number) => (number === '' ? NaN : Number(number)));
  const wrong = [];
  let nut = given.has('nut') ? numbers(given.get('nut')) : [0, 1];
  if (nut.length !== 2 || !nut.every(Number.isFinite)) { wrong.push('no diameter and density'); nut = [0, 1]; }
  const scene = nut[0] === 0 ? ROLLS : NUT;
  const steps = decodeURIComponent(given.get('plan') ?? '').split(';').filter(Boolean).map((step) => {
    const [at, setting] = step.split(':');
    return { at: natural(at, NaN), setting: numbers(setting) };
  });
  const ascends = steps.every((step, i) => (i === 0 ? step.at === 0 : step.at > steps[i - 1].at));
  const isWhole = steps.length > 0 && ascends && steps.every(({ setting }) => setting.length === scene.starts.length && setting.every(Number.isFinite));
  if (given.has('plan') && !isWhole) wrong.push('no whole plan');
  const [setting, value] = (given.get('beside') ?? '').split(':').map(Number);
  const isBeside = setting in scene.settings && Number.isFinite(value);
  if (given.has('beside') && !isBeside) wrong.push('no setting for the run beside it');
  const speed = given.get('speed') === 'max' ? Infinity : Number(given.get('speed'));
  return {
    scene, nut, seed: natural(given.get('seed'), 1), plan: isWhole ? steps : [{ at: 0, setting: [...scene.starts] }], at: natural(given.get('at'), 0),
    speed: speed > 0 ? speed : scene.speed, isPlaying: !given.has('paused'), beside: isBeside ? { setting, value } : null, wrong,
  };
}
