// What differs between an older build of a map and the current one.

import {olderBuilds} from './builds.js';
import {button, bytes, count, h, number} from './dom.js';

const MOST_ROWS = 100;

// "3 tiles new or changed, 210 kB, 1 tile removed"; `layers` are those of the tiles, or of the cells.
function differences(layers = {}, one) {
  const of = (key) => Object.values(layers).flatMap((layer) => layer[key]), changed = of('changed'), removed = of('removed');
  const sum = changed.reduce((total, tile) => total + tile.bytes, 0);
  const parts = [changed.length ? `${count(changed.length, one)} new or changed, ${bytes(sum)}` : '', removed.length ? `${count(removed.length, one)} removed` : ''];
  return parts.filter(Boolean).join(', ') || `the same ${one}s`;
}

function row({segment, change, tiles}, choose) {
  const texts = [h('span', {class: 'name'}, segment), h('span', {class: 'about'}, change === 'removed' ? change : `${change}: ${differences(tiles, 'tile')}`)];
  if (change === 'removed') return h('li', {class: 'row'}, ...texts);
  const node = button('', () => choose(segment), {class: 'row'});
  node.append(...texts);
  return h('li', {}, node);
}

function result(changes, choose) {
  const {segments, areas} = changes;
  const rows = segments.slice(0, MOST_ROWS).map((each) => row(each, choose)), rest = segments.length - rows.length;
  const heading = segments.length || areas || changes.document ? `${count(segments.length, 'segment')} differ${segments.length === 1 ? 's' : ''}, ${bytes(changes.bytes)} to fetch` : 'The two builds hold the same.';
  return [h('p', {class: 'sum'}, heading), areas ? h('p', {class: 'note'}, `Walls: ${differences(areas.cells, 'cell')}`) : null,
    h('ul', {class: 'rows'}, ...rows), rest ? h('p', {class: 'note'}, `${number(rest)} more`) : null].filter(Boolean);
}

// A part of a map's panel. `on`: {compare(build) promises the changes, choose(segment id)}.
export function changesPart(of, on) {
  const older = olderBuilds(of), shown = h('div', {'aria-live': 'polite'});
  const input = h('input', {type: 'text', id: 'from', spellcheck: 'false', autocomplete: 'off', list: 'older', placeholder: 'an older build',
    'aria-label': 'An older build: 32 digits', value: older[0]?.build ?? null});
  const form = h('form', {class: 'compare'}, input, h('datalist', {id: 'older'}, ...older.map(({build, seen}) => h('option', {value: build}, `seen on ${seen}`))),
    h('button', {type: 'submit'}, 'Compare'));
  form.addEventListener('submit', (event) => {
    event.preventDefault();
    if (!input.value.trim()) return;
    shown.replaceChildren(h('p', {class: 'note'}, 'Comparing…'));
    on.compare(input.value.trim()).then((changes) => shown.replaceChildren(...result(changes, on.choose)), (failure) => {
      const text = failure.status === 410 ? 'The server no longer has this build: it keeps one for a time after another took its place.' : failure.message;
      shown.replaceChildren(h('p', {class: 'note'}, text));
    });
  });
  const hint = older.length ? 'The builds that this browser has seen are offered.' : 'This browser has seen no other build of the map yet: write one, such as a client’s.';
  return h('details', {id: 'changes'}, h('summary', {}, 'Changes since an older build'), form, h('p', {class: 'note'}, hint), shown);
}
