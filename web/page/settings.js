// The settings, their sliders, and the address that holds a run: seed, plan, oscillations.

const log = (low, high) => ({ to: (share) => low * (high / low) ** share, from: (value) => Math.log(value / low) / Math.log(high / low) });
const square = (most) => ({ to: (share) => most * share * share, from: (value) => Math.sqrt(value / most) });

export const SETTINGS = [
  { symbol: 'κ', name: 'friction', start: 0.03, digits: 3, most: 10, ...log(0.004, 4) },
  { symbol: 'q', name: 'inelasticity', start: 0, digits: 2, most: 0.25, ...square(0.25) },
  { symbol: 'g', name: 'gravity', start: 0.015625, digits: 3, most: 1, ...log(0.001, 0.1) },
  { symbol: 'A', name: 'amplitude', start: 0.1, digits: 2, least: 0.01, most: 1, ...log(0.02, 0.5) },
  { symbol: 'ω', name: 'angular frequency', start: 10, digits: 2, least: 1, most: 50, ...log(2, 30) },
];
export const STARTS = SETTINGS.map((setting) => setting.start);

export const SPEED = log(0.01, 2000);
export const speedOf = (position) => (position >= 1000 ? Infinity : Number(SPEED.to(position / 1000).toPrecision(2)));
export const positionOf = (speed) => (speed === Infinity ? 1000 : Math.min(999, Math.round(1000 * SPEED.from(speed))));

export class Sliders {
  values = [...STARTS];
  #rows;

  constructor(parent, onChange) {
    this.#rows = SETTINGS.map((setting, i) => {
      const row = document.createElement('div');
      row.className = 'slider';
      row.innerHTML = `<label for="value-${i}"><b>${setting.symbol}</b> ${setting.name}</label>
        <input id="value-${i}" type="number" step="any" min="${setting.least ?? 0}" max="${setting.most}">
        <input id="slider-${i}" type="range" min="0" max="1" step="0.001" aria-label="${setting.name}">`;
      parent.append(row);
      const [number, range] = row.querySelectorAll('input');
      range.addEventListener('input', () => { this.#take(i, Number(setting.to(Number(range.value)).toPrecision(setting.digits))); onChange(); });
      number.addEventListener('change', () => {
        const valid = number.value !== '' && number.checkValidity();
        this.#take(i, valid ? Number(number.value) : this.values[i]);
        if (valid) onChange();
      });
      return { number, range };
    });
    this.show(this.values);
  }

  show(values) { values.forEach((value, i) => this.#take(i, value)); }

  #take(i, value) {
    this.values[i] = value;
    this.#rows[i].number.value = String(value);
    this.#rows[i].range.value = String(Math.max(0, Math.min(1, SETTINGS[i].from(Math.max(value, 1e-12)))));
  }
}

// Rounds as the sliders do.
export const rounded = (i, value) => Number(value.toPrecision(SETTINGS[i].digits));

export function toAddress({ seed, plan, at, speed, isPlaying }) {
  const steps = plan.map((step) => `${step.at}:${step.setting.join(',')}`).join(';');
  return `#seed=${seed}&plan=${steps}&at=${at}&speed=${speed === Infinity ? 'max' : speed}${isPlaying ? '' : '&paused'}`;
}

// Reads an address; what is missing or wrong in it is as at the start.
export function fromAddress(address) {
  const given = new Map(address.replace(/^#/, '').split('&').map((part) => part.split('=')));
  const natural = (text, otherwise) => (/^\d{1,10}$/.test(text ?? '') && Number(text) < 2 ** 32 ? Number(text) : otherwise);
  const steps = decodeURIComponent(given.get('plan') ?? '').split(';').filter(Boolean).map((step) => {
    const [at, numbers] = step.split(':');
    return { at: natural(at, NaN), setting: (numbers ?? '').split(',').map(Number) };
  });
  const ascends = steps.every((step, i) => (i === 0 ? step.at === 0 : step.at > steps[i - 1].at));
  const isWhole = steps.length > 0 && ascends && steps.every(({ setting }) => setting.length === STARTS.length && setting.every(Number.isFinite));
  const speed = given.get('speed') === 'max' ? Infinity : Number(given.get('speed'));
  return {
    seed: natural(given.get('seed'), 1), plan: isWhole ? steps : [{ at: 0, setting: [...STARTS] }], at: natural(given.get('at'), 0),
    speed: speed > 0 ? speed : 300, isPlaying: !given.has('paused'), isBroken: given.has('plan') && !isWhole,
  };
}
