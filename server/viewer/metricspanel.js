// The server's metrics, live: rates of counters, values of gauges, quantiles of histograms.

import {getText} from './api.js';
import {h, number} from './dom.js';
import {familiesOf, quantile, sumOf} from './prometheus.js';

const EVERY_MS = 5000;

// "milepost_http_requests_total" -> "http requests"
const words = (name) => name.replace(/^milepost_/, '').replace(/(_seconds)?(_total)?$/, '').replaceAll('_', ' ');

const unitOf = (name) => /_seconds(_total)?$/.test(name) ? 's' : /_bytes(_total)?$/.test(name) ? 'B' : '';

function scaled(value, unit) {
  if (value === null || !Number.isFinite(value)) return '–';
  if (unit === 's') return value < 1 ? `${number(value * 1000, value < 0.01 ? 1 : 0)}\u00a0ms` : `${number(value, 1)}\u00a0s`;
  const step = [[1e9, 'G'], [1e6, 'M'], [1e3, 'k']].find(([size]) => Math.abs(value) >= (unit ? size : size * 10));
  const [size, prefix] = step ?? [1, ''];
  return `${number(value / size, size > 1 || !Number.isInteger(value) ? 1 : 0)}${unit || prefix ? '\u00a0' : ''}${prefix}${unit}`;
}

// [name, what it is now, what it was in total] of a family; `before` is the one of `elapsed_s` earlier, or nothing.
function rowOf(name, family, before, elapsed_s) {
  const unit = unitOf(name);
  if (family.type === 'histogram') {
    const of = before && sumOf(family) > sumOf(before) ? before : null;  // without new events, since the start
    const [half, most] = [0.5, 0.99].map((share) => scaled(quantile(family, of, share), unit));
    return [words(name), `${half} median, ${most} p99`, `${scaled(sumOf(family), '')}`];
  }
  const value = sumOf(family);
  if (family.type !== 'counter') return [words(name), scaled(value, unit), ''];
  const rate = before ? Math.max(0, value - sumOf(before)) / elapsed_s : null;
  return [words(name), rate === null ? '–' : `${scaled(rate, unit)}/s`, `${scaled(value, unit)}`];
}

function table(families, before, elapsed_s) {
  const ours = [...families].filter(([name, {samples}]) => name.startsWith('milepost_') && samples.length);
  const rows = (ours.length ? ours : [...families].filter(([, {samples}]) => samples.length)).map(([name, family]) => {
    const [title, now, total] = rowOf(name, family, before?.get(name), elapsed_s);
    return h('tr', {title: family.help}, h('th', {scope: 'row'}, title), h('td', {}, now), h('td', {}, total));
  });
  return h('table', {}, h('thead', {}, h('tr', {}, h('th', {scope: 'col'}, 'what'), h('th', {scope: 'col'}, 'now'), h('th', {scope: 'col'}, 'since the start'))), h('tbody', {}, ...rows));
}

// A part that asks while it is open and the page is visible.
export function metricsPanel() {
  const body = h('div', {}, h('p', {class: 'note'}, 'Reading…'));
  const node = h('details', {id: 'metrics'}, h('summary', {}, 'Server, live'), body);
  let before = null, at_ms = 0;
  const ask = async () => {
    if (!node.open || document.hidden) return;
    try {
      const families = familiesOf(await getText('/metrics')), now_ms = performance.now();
      body.replaceChildren(table(families, before, (now_ms - at_ms) / 1000));
      [before, at_ms] = [families, now_ms];
    } catch (failure) {
      body.replaceChildren(h('p', {class: 'note'}, failure.message));
    }
  };
  node.addEventListener('toggle', ask);
  setInterval(ask, EVERY_MS);
  return node;
}
