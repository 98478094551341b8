// The panel of one segment: its numbers, its stretches as a plot, its tile index.

import {segmentPath} from './api.js';
import {classOf, colourName} from './colourings.js';
import {button, bytes, count, facts, h, metres, number, shape, withUnit} from './dom.js';
import {LANDMARKS, totals} from './stretches.js';

const MOST_ROWS = 60;
const PLOT = {width: 320, height: 64};

function plot(segment, colouring, on) {
  const {stretches, document: {length_m}} = segment;
  const values = stretches.map((stretch) => stretch[colouring.value]);
  const most = Math.max(colouring.isLessBetter ? colouring.limits.at(-1) : colouring.limits[0], ...values.filter((value) => value !== null));
  const bars = stretches.map((stretch, i) => {
    const x = stretch.from_m / length_m * PLOT.width, width = (stretch.to_m - stretch.from_m) / length_m * PLOT.width;
    const high = values[i] === null ? 3 : Math.max(3, values[i] / most * (PLOT.height - 4));
    const bar = shape('rect', {class: `class ${colourName(colouring, classOf(colouring, stretch))}`, x: x + Math.min(0.4, width / 8), y: PLOT.height - high,
      width: Math.max(width - Math.min(0.8, width / 4), 0.5), height: high});
    const hit = shape('rect', {class: 'hit', x, y: 0, width, height: PLOT.height}, shape('title', {}, stretchText(colouring, stretch)));
    hit.addEventListener('pointerenter', () => on.mark([stretch.from_m, stretch.to_m]));
    hit.addEventListener('pointerleave', () => on.mark(null));
    hit.addEventListener('click', () => on.goTo(stretch.from_m, stretch.to_m));
    return [bar, hit];
  });
  const label = `${colouring.heading}, on each ten metres of the segment; at most ${number(most, colouring.decimals)} is drawn`;
  return h('figure', {}, h('figcaption', {}, colouring.heading, h('span', {}, `0 to ${number(most, colouring.decimals)}`)),
    shape('svg', {class: 'plot', viewBox: `0 0 ${PLOT.width} ${PLOT.height}`, preserveAspectRatio: 'none', role: 'img', 'aria-label': label}, ...bars.flat()),
    h('p', {class: 'axis'}, h('span', {}, withUnit('0', 'm')), h('span', {}, 'along'), h('span', {}, metres(length_m))));
}

// "40 to 50 m: 17.5 landmarks a metre"
export function stretchText(colouring, stretch) {
  const value = stretch[colouring.value];
  const told = value === null ? colouring.without : withUnit(number(value, colouring.decimals), colouring.unit);
  return `${number(stretch.from_m)} to ${withUnit(number(stretch.to_m), 'm')}: ${told}`;
}

function tileTable(layer, tiles, on) {
  const rows = tiles.slice(0, MOST_ROWS).map((tile) => {
    const {index, from_m, to_m} = tile;
    const go = button(String(index), () => on.goTo(from_m, to_m), {'aria-label': `tile ${index}: show on the map`});
    const row = h('tr', {}, h('th', {scope: 'row'}, go), h('td', {}, `${number(from_m, 1)} – ${number(to_m, 1)}`), h('td', {}, number(tile.items)), h('td', {}, number(tile.bytes)));
    row.addEventListener('pointerenter', () => on.mark([from_m, to_m]));
    row.addEventListener('pointerleave', () => on.mark(null));
    return row;
  });
  const rest = tiles.length - rows.length;
  const heads = ['tile', 'along, m', layer === LANDMARKS ? 'landmarks' : 'items', 'bytes'];
  return h('details', {open: layer === LANDMARKS ? 'open' : null, class: 'tiles'}, h('summary', {}, `Tile index of ${layer}`),
    h('table', {}, h('thead', {}, h('tr', {}, ...heads.map((head) => h('th', {scope: 'col'}, head)))), h('tbody', {}, ...rows)),
    rest ? h('p', {class: 'note'}, `${count(rest, 'more tile')} in the `, 'document.') : null);
}

function sigmaText({position_sigma_m: sigma_m, assumed}) {
  if (sigma_m === undefined) return 'not known';
  return withUnit(number(sigma_m, 2), 'm') + (assumed ? ', assumed' : '');
}

const list = (heading, items) => items.length ? [h('h3', {}, heading), h('ul', {class: 'plain'}, ...items.map((item) => h('li', {}, item)))] : [];

// `on`: {back(), from() its name, goTo(from_m, to_m), mark(range or null), choose({map, segment})}.
export function segmentPanel(segment, colouring, on) {
  const {document} = segment, {length_m, passes, successors} = document, sums = totals(document), landmarks = totals(document, LANDMARKS);
  return [button(on.from(), on.back, {class: 'back'}), h('h2', {tabindex: -1}, document.segment),
    facts([['length', metres(length_m)], ['passes', number(passes.length)],
      ['landmarks', landmarks.tiles ? `${number(landmarks.items)}, ${withUnit(number(landmarks.items / length_m, 1), 'a metre')}` : 'none'],
      ['size', `${bytes(sums.bytes)}, ${withUnit(number(sums.bytes / 1000 / length_m, 2), 'kB/m')}`],
      ['position error (σ)', sigmaText(document)], ['tiles', number(sums.tiles)]]),
    plot(segment, colouring, on),
    ...Object.entries(document.tiles).filter(([, tiles]) => tiles.length).map(([layer, tiles]) => tileTable(layer, tiles, on)),
    ...list('Passes', passes.map(({drive, from_m, to_m}) => `${drive}, ${number(from_m, 1)} to ${withUnit(number(to_m, 1), 'm')} of the drive`)),
    ...list('Goes on to', successors.map((next) => button(next.map ? `${next.segment} of ${next.map}` : next.segment, () => on.choose(next), {class: 'link'}))),
    successors.length ? null : h('p', {class: 'note'}, 'The map ends at the end of this segment.'),
    h('p', {class: 'note'}, h('a', {href: segmentPath(segment)}, 'The segment’s document'), ' (JSON)')].filter(Boolean);
}
