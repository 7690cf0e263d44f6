// Saves what is seen as a picture, with all that is needed to see it again.

import { SETTINGS } from './settings.js';

const INK = '#22272e', QUIET = '#69727d', MARGIN = 28, HEADER = 84;

export function compose({ frame, run, values, state }) {
  const [box, order, diagram] = ['box', 'order', 'diagram'].map((id) => document.getElementById(id));
  const scale = box.width / box.clientWidth, size = (canvas) => [canvas.clientWidth, canvas.clientHeight];
  const [[bw, bh], [ow, oh], [dw, dh]] = [box, order, diagram].map(size);
  const sheet = document.createElement('canvas');
  const [width, height] = [3 * MARGIN + bw + Math.max(ow, dw), HEADER + Math.max(bh, oh + dh + 60) + 44];
  [sheet.width, sheet.height] = [width * scale, height * scale];
  const context = sheet.getContext('2d');
  context.scale(scale, scale);
  context.fillStyle = '#fff';
  context.fillRect(0, 0, width, height);
  const write = (text, x, y, font, color) => { context.font = `${font} system-ui, sans-serif`; context.fillStyle = color; context.fillText(text, x, y); };
  write(`1000 disks after ${Math.floor(frame.oscillations)} oscillations: ${state}`, MARGIN, 38, '600 18px', INK);
  write(SETTINGS.map((setting, i) => `${setting.symbol} = ${values[i]}`).join('    '), MARGIN, 62, '14px', QUIET);
  const left = 2 * MARGIN + bw;
  context.drawImage(box, MARGIN, HEADER, bw, bh);
  write('Ψ₁ one roll', left, HEADER + 14, '13px', '#0072b2');
  write('Ψ₂ two rolls', left + 90, HEADER + 14, '13px', '#d55e00');
  context.drawImage(order, left, HEADER + 22, ow, oh);
  write('states in the plane of friction and inelasticity', left, HEADER + oh + 50, '13px', INK);
  context.drawImage(diagram, left, HEADER + oh + 58, dw, dh);
  write(`seed ${run.seed}; state ${frame.hash.text} after ${frame.hash.at} oscillations; granular-edmd`, MARGIN, height - 16, '11px', QUIET);
  return sheet;
}

export function save(what) {
  compose(what).toBlob((blob) => {
    const link = document.createElement('a');
    link.href = URL.createObjectURL(blob);
    link.download = `rolls-${Math.floor(what.frame.oscillations)}.png`;
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 1000);
  });
}
