// Makes the static site from the repository: node site/build.mjs FOLDER DOCUMENTATION PAGE
//
// The pages of Markdown, and whatever they link to, become HTML; formulas become MathML, which browsers draw without fonts, scripts
// or a network. DOCUMENTATION is the folder of rustdoc, which has the API and the guide; PAGE that of the page of `web/`.

import { copyFileSync, cpSync, existsSync, mkdirSync, readFileSync, readdirSync, statSync, writeFileSync } from 'node:fs';
import { dirname, extname, join, posix, relative } from 'node:path';

import katex from 'katex';
import MarkdownIt from 'markdown-it';

const [out, documentation, page] = process.argv.slice(2);
const COPIED = new Set(['.png', '.svg', '.csv', '.txt', '.json', '.xz', '.ipynb', '.html', '.css']);
const API = 'api/granular_edmd', GUIDE = /^(?:(files|study)\/)?docs\/guide\/(\w+)\.md$/;
const DOCS_RS = /href="https:\/\/docs\.rs\/granular-edmd(?:-files|-study)?\/latest\/([^"]*)"/g;
const CRATE_DOC = /^(granular_edmd(_files|_study)?|src|static\.files|search\.(index|desc)|(trait|type)\.impl)$|\.(html|js)$/;
const DOCS = {
  physics: 'Every equation, its source, and the notation.', 'physics-kinetic': 'The closed form of the mean energy loss ⟨dE⟩.',
  reproduction: 'The figures and the table of the paper, beside those of this library.', validation: 'How the results were checked, and what that is worth.',
  'first-touch': 'A method: when a disk meets a wall that moves as it likes.', layers: 'A method: finding partners among disks of many sizes.',
  rest: 'What to do with matter at rest, and what it costs.', performance: 'How fast it is, and how to measure it.',
  'performance-details': 'What parts cost, where the time goes, and what was tried.',
  clusters: 'Studies on many processes and machines.', stability: 'What a new version may change.', architecture: 'Why the library is built as it is.',
  history: 'What changed before version 0.4.0.',
};
const NAVIGATION = [['index.html', 'granular-edmd'], ['rolls/index.html', 'Try it'], [`${API}/guide/index.html`, 'Guide'], ['docs/index.html', 'Docs'],
  ['gallery/index.html', 'Gallery'], ['docs/notebook/index.html', 'Python'], [`${API}/index.html`, 'API'], ['CHANGELOG.html', 'Changes']];

const escape = (text) => text.replace(/&/g, '&amp;').replace(/</g, '&lt;').replace(/>/g, '&gt;').replace(/"/g, '&quot;');
const unescape = (text) => text.replace(/&lt;/g, '<').replace(/&gt;/g, '>').replace(/&quot;/g, '"').replace(/&#39;/g, "'").replace(/&amp;/g, '&');
const formula = (source, displayMode) => katex.renderToString(source, { output: 'mathml', displayMode, throwOnError: true, strict: 'error' });

function write(path, text) {
  mkdirSync(dirname(join(out, path)), { recursive: true });
  writeFileSync(join(out, path), text);
}

// Markdown, with the formulas and the headings of code hosts.
const markdown = new MarkdownIt({ html: true });
markdown.core.ruler.push('formulas', ({ tokens }) => {
  for (const { children } of tokens.filter((token) => token.type === 'inline')) {
    children.forEach((code, i) => {
      const [before, after] = [children[i - 1], children[i + 1]];
      if (code.type !== 'code_inline' || !before?.content.endsWith('$') || !after?.content.startsWith('$')) return;
      before.content = before.content.slice(0, -1);
      after.content = after.content.slice(1);
      [code.type, code.content] = ['html_inline', formula(code.content, false)];
    });
  }
});
markdown.core.ruler.push('anchors', ({ tokens }) => {
  const seen = new Map();
  tokens.forEach((token, i) => {
    if (token.type !== 'heading_open') return;
    const text = tokens[i + 1].children.filter((child) => ['text', 'code_inline'].includes(child.type)).map((child) => child.content).join('');
    const slug = text.toLowerCase().replace(/[^\p{L}\p{N}\p{M} _-]/gu, '').replace(/ /g, '-'), count = seen.get(slug) ?? 0;
    seen.set(slug, count + 1);
    token.attrSet('id', count ? `${slug}-${count}` : slug);
  });
});
const fence = markdown.renderer.rules.fence;
markdown.renderer.rules.fence = (tokens, i, ...rest) => (tokens[i].info.trim() === 'math' ? formula(tokens[i].content, true) : fence(tokens, i, ...rest));

function framed(path, title, body) {
  const up = (target) => posix.relative(posix.dirname(path), target) || '.';
  const links = NAVIGATION.map(([target, name]) => `<a href="${up(target)}"${target === path ? ' aria-current="page"' : ''}>${name}</a>`).join('\n');
  return `<!doctype html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>${escape(title)}</title>
<link rel="icon" href="data:,">
<link rel="stylesheet" href="${up('site.css')}">
</head>
<body>
<nav aria-label="Site">
${links}
</nav>
<main>
${body}
</main>
</body>
</html>
`;
}

// Where a file or a folder of the repository is on the site. What is not there yet is made.
const made = new Map(), waiting = [], faults = [];
function placed(path) {
  if (!made.has(path)) { made.set(path, placeOf(path)); waiting.push(path); }
  return made.get(path);
}
function placeOf(path) {
  const guide = GUIDE.exec(path);
  if (guide) return `${API}${guide[1] ? `_${guide[1]}` : ''}/guide/${guide[2] === 'index' ? '' : `${guide[2]}/`}index.html`;
  if (path.endsWith('.md')) return path.replace(/README\.md$/, 'index.html').replace(/\.md$/, '.html');
  if (statSync(path).isDirectory()) return posix.join(path, 'index.html');
  return COPIED.has(extname(path)) ? path : `${path}.html`;
}

// The documentation is on the site, too.
const here = (html, file) => html.replace(DOCS_RS, (_, path) => `href="${posix.relative(posix.dirname(file), posix.join('api', path))}"`);

// Links of a page of the repository become those of the site.
function linked(html, from) {
  return html.replace(/(\s(?:href|src)=")([^"]*)"/g, (whole, attribute, link) => {
    if (/^([a-z]+:|\/\/|#)/.test(link)) return here(whole, placeOf(from));
    const [path, anchor] = unescape(link).split('#'), target = posix.normalize(posix.join(posix.dirname(from), decodeURIComponent(path))).replace(/\/$/, '');
    if (!existsSync(target)) { faults.push(`${from} links to ${link}, which is not there`); return whole; }
    return `${attribute}${escape(posix.relative(posix.dirname(placeOf(from)), placed(target)))}${anchor ? `#${anchor}` : ''}"`;
  });
}

function make(path) {
  const place = made.get(path);
  if (GUIDE.test(path)) return;
  if (path.endsWith('.md')) {
    const html = markdown.render(readFileSync(path, 'utf8'))
      .replace(/<table>[^]*?<\/table>/g, '<div class="wide" tabindex="0" role="region" aria-label="table">$&</div>').replace(/<th[^>]*><\/th>/g, '<td></td>');
    const title = /<h1[^>]*>([^]*?)<\/h1>/.exec(html)?.[1].replace(/<[^>]*>/g, '') ?? path;
    write(place, framed(place, unescape(title), linked(html, path)));
  } else if (statSync(path).isDirectory()) {
    if (existsSync(join(path, 'README.md'))) { placed(posix.join(path, 'README.md')); return; }
    const names = readdirSync(path).filter((name) => !name.startsWith('.') && name !== 'target').sort();
    const items = names.map((name) => `<li><a href="${posix.relative(path, placed(posix.join(path, name)))}">${escape(name)}</a></li>`).join('\n');
    write(place, framed(place, path, `<h1>${escape(path)}</h1>\n<ul>\n${items}\n</ul>`));
  } else if (COPIED.has(extname(path))) {
    mkdirSync(dirname(join(out, place)), { recursive: true });
    copyFileSync(path, join(out, place));
  } else {
    write(place, framed(place, path, `<h1>${escape(path)}</h1>\n<pre><code>${escape(readFileSync(path, 'utf8'))}</code></pre>`));
  }
}

// An overview of the pages of docs.
function overview() {
  const items = Object.entries(DOCS).map(([name, about]) => {
    const [, title] = /^# (.*)$/m.exec(readFileSync(`docs/${name}.md`, 'utf8'));
    placed(`docs/${name}.md`);
    return `<dt><a href="${name}.html">${markdown.renderInline(title)}</a></dt><dd>${about}</dd>`;
  });
  write('docs/index.html', framed('docs/index.html', 'Docs', `<h1>Docs</h1>\n<dl>\n${items.join('\n')}\n</dl>`));
}

// The API and the guide, whose formulas rustdoc leaves as TeX.
function document() {
  for (const name of readdirSync(documentation).filter((name) => CRATE_DOC.test(name))) cpSync(join(documentation, name), join(out, 'api', name), { recursive: true });
  write('api/index.html', '<!doctype html>\n<title>granular_edmd</title>\n<meta http-equiv="refresh" content="0; url=granular_edmd/index.html">\n<a href="granular_edmd/index.html">granular_edmd</a>\n');
  let count = 0;
  // Pictures of pages that the package has without them.
  const shown = (file) => (_, path) => `src="${posix.relative(posix.dirname(posix.join('api', file)), placed(path))}"`;
  for (const file of readdirSync(join(out, 'api'), { recursive: true }).filter((name) => name.endsWith('.html'))) {
    const path = join(out, 'api', file), text = readFileSync(path, 'utf8');
    const drawn = here(text, posix.join('api', file))
      .replace(/<div class="example-wrap"><pre class="language-math"><code>([^]*?)<\/code><\/pre><\/div>/g, (_, source) => { count += 1; return formula(unescape(source), true); })
      .replace(/\$<code>([^<]*)<\/code>\$/g, (_, source) => { count += 1; return formula(unescape(source), false); })
      .replace(/<section id="main-content"[^>]*>/, (whole) => `${whole}<a href="${posix.relative(posix.dirname(posix.join('api', file)), 'index.html')}">← site</a>`)
      .replace(/src="data:image\/png,#([^"]+)"/g, shown(file));
    if (drawn !== text) writeFileSync(path, drawn);
  }
  return count;
}

const formulas = document();
cpSync(page, join(out, 'rolls'), { recursive: true });
copyFileSync('site/site.css', join(out, 'site.css'));
for (const path of ['README.md', 'gallery/README.md', 'docs/notebook/README.md', 'CHANGELOG.md', 'CONTRIBUTING.md', 'web/README.md']) placed(path);
overview();
while (waiting.length > 0) make(waiting.shift());
console.log(`${made.size} files of the repository, ${formulas} formulas in the documentation: ${relative('', out)}/index.html`);
for (const fault of faults) console.error(`error: ${fault}`);
process.exit(faults.length > 0 ? 1 : 0);
