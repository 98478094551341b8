// The textual parts of a page: head, tables, legends and captions. Strings of the data become text nodes only.
'use strict';

const page = JSON.parse(document.getElementById('data').textContent);

// h('p', {class: 'note'}, ...): an element; children are elements or text.
function h(tag, attributes = {}, ...children) {
  const node = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) node.setAttribute(name, value);
  node.append(...children);
  return node;
}

// A formatted number: typographic minus sign, an en dash for missing values.
function number(value, decimals, signed = false) {
  if (value === null || value === undefined) return '–';
  const digits = Math.abs(value).toFixed(decimals);
  if (!/[1-9]/.test(digits)) return digits;
  return (value < 0 ? '−' : signed ? '+' : '') + digits;
}

// A column of the page by its name, or an array of values itself.
const column = (reference) => typeof reference === 'string' ? page.columns[reference] : reference;

function cell(value, of, isBest) {
  const text = typeof value === 'string' ? value : number(value, of.decimals);
  if (of.decimals === null) return h('th', {scope: 'row'}, text);
  return h('td', {'data-label': of.heading, 'data-unit': of.unit, ...(of.text ? {class: 'words'} : {})}, isBest ? h('strong', {}, text) : text);
}

function row(of, columns) {
  if (of.group !== undefined) return h('tr', {class: 'group'}, h('th', {scope: 'rowgroup', colspan: columns.length}, of.group));
  return h('tr', {}, ...of.cells.map((value, i) => cell(value, columns[i], (of.best || []).includes(i))));
}

function table(part) {
  const heads = part.columns.map((each) => h('th', {scope: 'col', ...(each.text ? {class: 'words'} : {})}, each.heading, ' ', h('small', {}, each.unit)));
  return h('table', {}, h('thead', {}, h('tr', {}, ...heads)), h('tbody', {}, ...part.rows.map((each) => row(each, part.columns))));
}

// The legend sample of a layer, 22 x 12 pixels.
function sample(layer) {
  const svg = document.createElementNS('http://www.w3.org/2000/svg', 'svg');
  const shape = (tag, attributes) => {
    const node = document.createElementNS(svg.namespaceURI, tag);
    for (const [name, value] of Object.entries(attributes)) node.setAttribute(name, value);
    svg.append(node);
  };
  const look = layer.kind === 'status' ? STATUS[layer.name] : layer;
  const paint = `var(--${look.colour})`;
  svg.setAttribute('aria-hidden', 'true');
  if (look.marker === 'line') {
    shape('path', {d: 'M11 0V12', stroke: paint, 'stroke-width': look.edge_px});
  } else if (look.kind === 'dots') {
    shape('circle', {cx: 11, cy: 6, r: Math.min(look.radius_px || 2, 5), fill: `var(--${look.fill || look.colour})`, stroke: paint,
      'stroke-width': look.edge_px || 0});
  } else if (look.kind === 'band' || look.kind === 'area') {
    shape('rect', {width: 22, height: 10, y: 1, fill: paint, opacity: look.opacity || 1});
  } else {
    shape('path', {d: 'M1 6H21', stroke: paint, 'stroke-width': layer.kind === 'status' ? look.width_px : Math.max(look.width_px || 0, 2.5), 'stroke-dasharray': (look.dash || []).join(' '),
      opacity: look.opacity || 1});
  }
  return svg;
}

// One entry per name; of several layers with the same name the first is shown.
function legend(layers) {
  const named = new Map();
  for (const layer of layers) if (layer.name && !named.has(layer.name)) named.set(layer.name, layer);
  const entries = [...named].map(([name, layer]) => h('span', {}, sample(layer), name));
  return entries.length ? [h('p', {class: 'legend'}, ...entries)] : [];
}

const note = (text) => text ? [h('p', {class: 'note'}, text)] : [];

const parts = {
  title: (part) => h('h2', {class: 'part'}, part.heading),
  table: (part) => part.folded
    ? h('details', {}, h('summary', {}, 'Table'), table(part))
    : h('section', {}, h('h2', {}, part.heading), table(part), ...note(part.note)),
  group: (part) => h('section', {}, ...(part.heading ? [h('h2', {}, part.heading)] : []), ...legend(part.keys || []),
    h('div', {class: 'pair'}, ...part.parts.map(shown)), ...note(part.note)),
  note: (part) => h('section', {}, h('h2', {}, part.heading), ...note(part.text)),
  plan: networkElement,
  strips: stripsElement,
  segment: segmentElement,
  claims: (part) => h('section', {}, h('h2', {}, part.heading), h('ul', {class: 'claims'}, ...part.claims.map((claim) =>
    h('li', {}, h('p', {class: `verdict ${claim.verdict.replace(' ', '-')}`}, claim.verdict),
      h('div', {}, h('p', {}, claim.text), h('p', {class: 'figures'}, claim.figures))))), ...note(part.note)),
  figure: (part) => {
    const body = part.plots.length
      ? [...legend(part.plots.flatMap((plot) => plot.legend === false ? [] : plot.layers)), ...legend(part.keys || []),
        h('div', {class: part.plots.length > 1 && !part.stacked ? 'plots' : ''}, ...part.plots.map(plotElement))]
      : [h('p', {class: 'empty'}, 'There is nothing to draw: no frame has the numbers that this figure shows.')];
    return h('figure', {}, h('h2', {}, part.heading), ...body, h('figcaption', {}, part.caption));
  },
};

const shown = (part) => parts[part.part](part);

const HOW = 'Drag across a plot to zoom in, double-click to reset. Drag a plan to move it and use the mouse wheel to zoom. Keys: arrows, + and −, Escape.';

function head() {
  document.title = `${page.title} – milepost ${page.kind}`;
  const facts = page.facts.map(([name, value]) => h('div', {}, h('dt', {}, name), h('dd', {}, value || 'not stated')));
  return h('header', {}, h('p', {class: 'over'}, `milepost ${page.kind}`), h('h1', {}, page.title),
    h('p', {class: 'lead'}, page.lead), h('dl', {}, ...facts), h('p', {class: 'note how'}, HOW));
}
