// Colors, those of the style sheet: for a light or a dark system, and canvases that fit their place.

const NAMES = ['ink', 'quiet', 'line', 'paper', 'faint', 'wall', 'rule', 'mark', 'clockwise', 'even', 'counter', 'one', 'two', 'change',
  'area-none', 'area-one', 'area-both', 'area-two', 'area-collapse', 'hatch', 'collapse', 'halo'];
const dark = window.matchMedia('(prefers-color-scheme: dark)');

export const look = { scheme: '' };

function read() {
  const style = getComputedStyle(document.documentElement);
  for (const name of NAMES) look[name] = style.getPropertyValue(`--${name}`).trim();
  // From blue through a gray to vermillion, both of Okabe and Ito, softened so that arrows stand out.
  const [clockwise, even, counter] = ['clockwise', 'even', 'counter'].map((name) => look[name].split(' ').map(Number));
  look.shades = [-1, -0.75, -0.5, -0.25, 0, 0.25, 0.5, 0.75, 1].map((level) => {
    const end = level < 0 ? clockwise : counter, share = 0.82 * Math.abs(level);
    return `rgb(${even.map((gray, i) => Math.round(gray + share * (end[i] - gray))).join(' ')})`;
  });
  look.scheme = dark.matches ? 'dark' : 'light';
}
read();
dark.addEventListener('change', read);

export const font = (size, weight = '') => `${weight} ${size}px system-ui, sans-serif`;

export function fit(canvas) {
  const scale = Math.min(window.devicePixelRatio || 1, 2);
  const [width, height] = [Math.round(canvas.clientWidth * scale), Math.round(canvas.clientHeight * scale)];
  if (canvas.width !== width || canvas.height !== height) { canvas.width = width; canvas.height = height; }
  const context = canvas.getContext('2d');
  context.setTransform(scale, 0, 0, scale, 0, 0);
  context.clearRect(0, 0, canvas.clientWidth, canvas.clientHeight);
  return context;
}
