// The panel of the catalog, of what was found near a position, and of one map.

import {button, count, facts, h, metres, number, withUnit} from './dom.js';

const MOST_ROWS = 24;  // whose documents are read, as at the start
const MOST_SEGMENTS = 100;

function row(of, choose, describe) {
  const about = h('span', {class: 'about'}, '\u00a0');
  const node = h('li', {}, button(of.map, () => choose(of), {class: 'row'}));
  node.firstChild.replaceChildren(h('span', {class: 'name'}, of.map), about);
  describe(of).then((document) => {
    const {segments, length_m, layers} = document;
    const roads = segments.length ? `${metres(length_m)} in ${count(segments.length, 'segment')}` : 'no segments';
    about.textContent = layers.includes('walls') ? `${roads}, walls` : roads;
  }, (failure) => { about.textContent = failure.message; });
  return node;
}

// The maps whose names have the text in them. `describe(of)` promises a map's document.
export function catalogPanel(maps, filter, choose, describe) {
  if (!maps.length) {
    return [h('p', {class: 'empty'}, 'The server has no maps yet. Put map files into its directory (', h('code', {}, '--maps'),
      '); ', h('code', {}, 'milepost-mapper build'), ' makes them from recorded drives.')];
  }
  const wanted = filter.toLowerCase(), found = maps.filter(({map}) => map.toLowerCase().includes(wanted));
  if (!found.length) return [h('p', {class: 'empty'}, `No map has “${filter}” in its name. For a position write latitude and longitude in degrees, such as 49.0102, 8.4011.`)];
  const shown = found.slice(0, MOST_ROWS), rest = found.length - shown.length;
  return [h('p', {class: 'over'}, filter ? `${number(found.length)} of ${count(maps.length, 'map')}` : count(maps.length, 'map')),
    h('ul', {class: 'rows'}, ...shown.map((of) => row(of, choose, describe))),
    rest ? h('p', {class: 'note'}, `${count(rest, 'more map')}: write a part of the name above.`) : null].filter(Boolean);
}

export function nearPanel(at, near, radius_m, choose, back) {
  const rows = near.slice(0, MOST_ROWS).map((of) => {
    const node = button('', () => choose(of), {class: 'row'});
    node.append(h('span', {class: 'name'}, of.segment),
      h('span', {class: 'about'}, `${of.map}: ${withUnit(number(of.distance_m, 1), 'm')} away, at ${withUnit(number(of.along_m, 1), 'm')} of ${metres(of.length_m)}`));
    return h('li', {}, node);
  });
  return [button('All maps', back, {class: 'back'}), h('h2', {tabindex: -1}, 'Near ', h('span', {class: 'position'}, at)),
    rows.length ? h('ul', {class: 'rows'}, ...rows) : h('p', {class: 'empty'}, `No segment passes within ${metres(radius_m)} of this position.`),
    near.length > rows.length ? h('p', {class: 'note'}, `${count(near.length - rows.length, 'more segment')}, farther away.`) : null].filter(Boolean);
}

const FIT = [['frames', 'adjusted', (fit) => number(fit.frames)],
  ['fit, %', 'share of the features that fit', (fit) => fit.followed ? number(100 * fit.fitting / fit.followed) : '–'],
  ['error, px', 'reprojection error of these', (fit) => number(fit.reprojection_px, 2)],
  ['moved, m', 'from the recorded to the adjusted poses, in plan', (fit) => number(fit.plan_rms_m, 3)]];

// The record of the mapping; null for a map without one.
function recordPart(record) {
  if (!record) return [h('p', {class: 'note'}, 'The map has no record of its mapping: build it anew to have one.')];
  const drives = h('table', {}, h('thead', {}, h('tr', {}, h('th', {scope: 'col'}, 'drive'), ...FIT.map(([name, title]) => h('th', {scope: 'col', title}, name)))),
    h('tbody', {}, ...record.drives.map((drive) => h('tr', {}, h('th', {scope: 'row'}, drive.drive), ...FIT.map(([, , value]) => h('td', {}, value(drive)))))));
  const findings = record.findings.map((finding) => h('li', {}, h('strong', {}, [finding.drive, finding.where].filter(Boolean).join(', ')), ' ',
    finding.what, finding.hint ? h('span', {class: 'note'}, ` ${finding.hint}`) : null));
  return [drives, h('h3', {}, findings.length ? count(findings.length, 'finding') : 'No findings'), ...(findings.length ? [h('ul', {class: 'findings'}, ...findings)] : [])];
}

// One map. `on`: {choose(segment id), back(), record() promises the record}; `more` is shown after the record.
export function mapPanel(of, document, more, on) {
  const {segments, layers, length_m, datum} = document;
  const shown = segments.slice(0, MOST_SEGMENTS), rest = segments.length - shown.length;
  const record = h('details', {}, h('summary', {}, 'Record of the mapping'), h('p', {class: 'note'}, 'Reading…'));
  record.addEventListener('toggle', () => {
    on.record().then((of_) => record.replaceChildren(record.firstChild, ...recordPart(of_)),
      (failure) => record.replaceChildren(record.firstChild, h('p', {class: 'note'}, failure.message)));
  }, {once: true});
  return [button('All maps', on.back, {class: 'back'}), h('h2', {tabindex: -1}, of.map),
    facts([segments.length ? ['length', metres(length_m)] : null, segments.length ? ['segments', number(segments.length)] : null, ['layers', layers.join(', ')],
      ['build', h('code', {title: of.build}, of.build.slice(0, 12))], datum ? ['datum', datum] : null]),
    segments.length ? record : null, more,
    segments.length ? h('h3', {}, 'Segments') : h('p', {class: 'empty'}, layers.includes('walls')
      ? 'The map has walls only, and no segments: a vehicle without a receiver finds itself by them.'
      : 'The map has no segments.'),
    h('ul', {class: 'rows plain'}, ...shown.map((id) => h('li', {}, button(id, () => on.choose(id), {class: 'row'})))),
    rest ? h('p', {class: 'note'}, `${count(rest, 'more segment')}: choose them on the map.`) : null].filter(Boolean);
}
