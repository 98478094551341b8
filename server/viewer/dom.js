// Elements and the texts of numbers. Strings of the server become text nodes only.

// h('p', {class: 'note'}, ...): an element; children are elements or text; attributes that are null are left out.
export function h(tag, attributes = {}, ...children) {
  return filled(document.createElement(tag), attributes, children);
}

export function shape(tag, attributes = {}, ...children) {
  return filled(document.createElementNS('http://www.w3.org/2000/svg', tag), attributes, children);
}

function filled(node, attributes, children) {
  for (const [name, value] of Object.entries(attributes)) if (value !== null && value !== undefined) node.setAttribute(name, value);
  node.append(...children.filter((child) => child !== null));
  return node;
}

export function button(text, action, attributes = {}) {
  const node = h('button', {type: 'button', ...attributes}, text);
  node.addEventListener('click', action);
  return node;
}

const NO_BREAK = '\u00a0', NARROW = '\u202f';

// A number with a typographic minus and groups of three digits; an en dash for a missing value.
export function number(value, decimals = 0) {
  if (value === null || value === undefined || !Number.isFinite(value)) return '–';
  const [whole, fraction] = Math.abs(value).toFixed(decimals).split('.');
  const grouped = whole.length > 4 ? whole.replace(/\B(?=(\d{3})+$)/g, NARROW) : whole;
  return (value < 0 ? '−' : '') + (fraction ? `${grouped}.${fraction}` : grouped);
}

export const withUnit = (text, unit) => `${text}${NO_BREAK}${unit}`;

// "58.0 m", "1.83 km"
export function metres(value) {
  if (value === null || value === undefined) return '–';
  if (value >= 10_000) return withUnit(number(value / 1000, 1), 'km');
  return value >= 1000 ? withUnit(number(value / 1000, 2), 'km') : withUnit(number(value, 1), 'm');
}

// "812 B", "27.8 kB", "1.4 MB": a kilobyte has 1000 bytes.
export function bytes(value) {
  if (value < 1000) return withUnit(number(value), 'B');
  return value < 1e6 ? withUnit(number(value / 1e3, 1), 'kB') : withUnit(number(value / 1e6, 1), 'MB');
}

export const count = (value, one, many = `${one}s`) => `${number(value)}${NO_BREAK}${value === 1 ? one : many}`;

export const position = (latitude, longitude) => `${number(latitude, 6)}, ${number(longitude, 6)}`;

// dl of [name, value]; a value is text or an element; entries without one are left out.
export function facts(entries) {
  return h('dl', {}, ...entries.filter((entry) => entry && entry[1] !== null).map(([name, value]) =>
    h('div', {}, h('dt', {}, name), h('dd', {}, value))));
}
