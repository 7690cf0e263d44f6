// Saves what is seen as a picture, with all that is needed to see it again.

import { font, look } from './look.js';

const MARGIN = 28, HEADER = 84;

export function compose({ title, about, foot, boxes, plots }) {
  const scale = boxes[0].width / boxes[0].clientWidth, high = (canvases) => canvases.map((canvas) => canvas.clientHeight);
  const [left, wide] = [2 * MARGIN + boxes.reduce((sum, box) => sum + box.clientWidth + 12, -12), Math.max(...plots.map(({ canvas }) => canvas.clientWidth))];
  const tall = high(plots.map(({ canvas }) => canvas)).reduce((sum, height) => sum + height + 44, 0);
  const [width, height] = [left + wide + MARGIN, HEADER + Math.max(...high(boxes), tall) + 44];
  const sheet = document.createElement('canvas');
  [sheet.width, sheet.height] = [width * scale, height * scale];
  const context = sheet.getContext('2d');
  context.scale(scale, scale);
  context.fillStyle = look.paper;
  context.fillRect(0, 0, width, height);
  const write = (text, x, y, face, color) => { context.font = face; context.fillStyle = color; context.fillText(text, x, y); };
  write(title, MARGIN, 38, font(18, 600), look.ink);
  write(about, MARGIN, 62, font(14), look.quiet);
  let x = MARGIN, y = HEADER;
  for (const box of boxes) { context.drawImage(box, x, HEADER, box.clientWidth, box.clientHeight); x += box.clientWidth + 12; }
  for (const { canvas, names } of plots) {
    names.forEach(([name, color], k) => write(name, left + 190 * k, y + 14, font(13), color));
    context.drawImage(canvas, left, y + 22, canvas.clientWidth, canvas.clientHeight);
    y += canvas.clientHeight + 44;
  }
  write(foot, MARGIN, height - 16, font(11), look.quiet);
  return sheet;
}

export function saveAs(name, blob) {
  const link = document.createElement('a');
  link.href = URL.createObjectURL(blob);
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 1000);
}

export function save(what, name) { compose(what).toBlob((blob) => saveAs(`${name}.png`, blob)); }

export const canRecord = 'MediaRecorder' in globalThis && 'captureStream' in HTMLCanvasElement.prototype;

// Records what a canvas shows for some seconds.
export function record(canvas, seconds, name) {
  const recorder = new MediaRecorder(canvas.captureStream(30)), parts = [], type = recorder.mimeType || 'video/webm';
  recorder.ondataavailable = ({ data }) => parts.push(data);
  const ended = new Promise((done) => { recorder.onstop = done; });
  recorder.start();
  setTimeout(() => recorder.stop(), 1000 * seconds);
  return ended.then(() => saveAs(`${name}.${type.includes('mp4') ? 'mp4' : 'webm'}`, new Blob(parts, { type })));
}
