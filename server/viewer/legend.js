// The choice of what colours the roads, its colours, and what is shown from near.

import {COLOURINGS} from './colourings.js';
import {h} from './dom.js';
import {KINDS} from './places.js';

function choice(colouring, chosen, choose) {
  const input = h('input', {type: 'radio', name: 'colouring', value: colouring.id, checked: colouring === chosen ? 'checked' : null});
  input.addEventListener('change', () => choose(colouring));
  return h('label', {title: colouring.caption}, input, colouring.name);
}

function bar(colouring, hasMissing) {
  const cells = colouring.names.map((name, i) => h('span', {class: `class ${colouring.colours[i]}`}, name));
  if (hasMissing) cells.push(h('span', {class: 'class none'}, colouring.without));
  return h('p', {class: 'bar'}, ...cells);
}

function kind({id, name, zoom}, {wanted, atZoom, want}) {
  const input = h('input', {type: 'checkbox', id: `show-${id}`, checked: wanted.has(id) ? 'checked' : null});
  input.addEventListener('change', () => want(id, input.checked));
  const isFar = atZoom < zoom;
  return h('label', {class: isFar ? 'far' : null, title: isFar ? 'Seen when you zoom in' : null}, input, h('span', {class: `sample ${id}`}), name);
}

// `state`: {colouring, hasMissing, wanted, atZoom}; `on`: {choose(colouring), want(kind, isWanted)}.
function parts(state, on) {
  const far = KINDS.filter(({id, zoom}) => state.wanted.has(id) && state.atZoom < zoom).map(({name}) => name);
  const hint = far.length ? `zoom in for ${far.join(', ').replace(/, (?=[^,]*$)/, ' and ')}` : 'drawn where a map has them';
  return [
    h('fieldset', {class: 'views'}, h('legend', {}, 'Coloured by'), ...COLOURINGS.map((each) => choice(each, state.colouring, on.choose))),
    h('h2', {}, state.colouring.heading), bar(state.colouring, state.hasMissing),
    h('div', {class: 'kinds'}, ...KINDS.map((each) => kind(each, {...state, want: on.want})), h('span', {class: 'hint'}, hint)),
  ];
}

// Draws the legend anew; what had the focus in it has it again.
export function replaceLegend(node, state, on) {
  const {id, value} = node.contains(document.activeElement) ? document.activeElement : {};
  node.replaceChildren(...parts(state, on));
  const again = id ? document.getElementById(id) : value && node.querySelector(`[value="${value}"]`);
  again?.focus();
}
