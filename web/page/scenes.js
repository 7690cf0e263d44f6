// The scenes: boxes, the settings of their sliders, and what is plotted over time.

const log = (low, high) => ({ to: (share) => low * (high / low) ** share, from: (value) => Math.log(value / low) / Math.log(high / low) });
const square = (most) => ({ to: (share) => most * share * share, from: (value) => Math.sqrt(value / most) });
const digits = (count) => ({ round: (value) => Number(value.toPrecision(count)) });

const friction = { symbol: 'κ', name: 'friction', least: 0, most: 10, ...digits(3), ...log(0.004, 4) };
const inelasticity = { symbol: 'q', name: 'inelasticity', least: 0, most: 0.25, round: (value) => Math.round(value * 2000) / 2000, ...square(0.25) };
const gravity = { symbol: 'g', name: 'gravity', least: 0, ...digits(3) };
const amplitude = { symbol: 'A', name: 'amplitude', least: 0.01, ...digits(2) };
const frequency = { symbol: 'ω', name: 'angular frequency', ...digits(2) };

export const ROLLS = {
  name: 'rolls', title: 'Convection rolls of shaken disks', width: 60, height: 150, columns: 10, rows: 25, leastFlow: 0.12, enough: 0.08, speed: 300,
  settings: [friction, inelasticity, { ...gravity, most: 1, ...log(0.001, 0.1) }, { ...amplitude, most: 1, ...log(0.02, 0.5) },
    { ...frequency, least: 1, most: 50, ...log(2, 30) }],
  starts: [0.03, 0, 0.015625, 0.1, 10],
  plot: { columns: ['run', 'oscillations', 'one_roll', 'two_rolls', 'noise'], window: 3000, stride: 1000, least: -0.13, most: 0.13, digits: 2, steps: [0.05, 0.1, 0.25] },
};

export const NUT = {
  name: 'nut', title: 'A large disk among small ones', width: 30, height: 50, columns: 10, rows: 17, leastFlow: 0.06, enough: 0.3, speed: 10,
  settings: [friction, inelasticity, { ...gravity, most: 20, ...log(0.2, 5) }, { ...amplitude, most: 3, ...log(0.1, 3) },
    { ...frequency, least: 0.2, most: 10, ...log(0.5, 5) }],
  starts: [0.3, 0.05, 1, 1, 2.3],
  plot: { columns: ['run', 'oscillations', 'large_disk_height', 'mean_height_of_others'], window: 300, stride: 100, least: 0, most: 20, digits: 0, steps: [5, 10, 20] },
};

export const sceneOf = ({ nut }) => (nut[0] === 0 ? ROLLS : NUT);
