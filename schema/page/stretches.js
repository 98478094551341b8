// The report of a map: its segments in stretches, on the plan, in strips and along one of them. The stretches are the page's frames.

const CELLS = 50;        // stretches in a line of a strip
const LINE_PX = 20;      // of a strip
const CELL = 0.7, BAR = [0.82, 0.16];  // shares of a line: a cell's height, and the bar of a gap beneath it
let view = 0;            // what colours the stretches: a number in page.views
let chosen = null;       // number of a stretch

const segmentOf = (frame) => page.segments[column('segment')[frame]];

const spanOf = (frame) => `${number(column('from_m')[frame], 0)} to ${number(column('to_m')[frame], 0)} m`;

const titleOf = (frame) => `${segmentOf(frame).name}, ${spanOf(frame)}`;

// Points of the lines of the stretches that hold a condition; a gap where a line ends.
function ways(holds) {
  const [segments, first, count, east, north] = ['segment', 'way_first', 'way_points', 'way_east_m', 'way_north_m'].map(column);
  const points = [];
  let before = null;  // the stretch before, if it was drawn
  for (let i = 0; i < segments.length; ++i) {
    if (!holds(i)) continue;
    const goesOn = before === i - 1 && segments[before] === segments[i];
    if (!goesOn && points.length) points.push({x: null, y: null});
    for (let k = goesOn ? 1 : 0; k < count[i]; ++k) points.push({x: east[first[i] + k], y: north[first[i] + k]});
    before = i;
  }
  return points;
}

// The looks of the classes of a view, from the best to the worst; the last is that of stretches without a value.
function looks({classes, without}) {
  return [...classes.map((each, i) => ({...each, is: i})), {name: without, colour: 'none', is: null}];
}

// A layer for each class, the worst first, which the library draws on top.
function stretchLayers(layer) {
  const classes = column(page.views[view].column);
  return looks(page.views[view]).reverse().map((look) => ({...layer, ...look, holds: (i) => classes[i] === look.is}));
}

// The chosen segment, and on it the chosen stretch.
function chosenLayers(layer) {
  if (chosen === null) return [];
  const segment = column('segment')[chosen];
  return [{...layer, width_px: 1.5 * layer.width_px, holds: (i) => i === chosen}, {...layer, holds: (i) => column('segment')[i] === segment}];
}

// From a point of a plan to the line of a stretch, in pixels; infinite if the stretch is too far away to be meant.
function distanceToWay({chart: {scales: {x, y}}}, frame, atX, atY) {
  const half = (column('to_m')[frame] - column('from_m')[frame]) / 2 * x.width / (x.max - x.min);
  const middle = [x.getPixelForValue(column('east_m')[frame]), y.getPixelForValue(column('north_m')[frame])];
  if (Math.hypot(middle[0] - atX, middle[1] - atY) > NEAR_PX + half + 1) return Infinity;
  const first = column('way_first')[frame];
  let least = Infinity, from = null;
  for (let k = first; k < first + column('way_points')[frame]; ++k) {
    const to = [x.getPixelForValue(column('way_east_m')[k]), y.getPixelForValue(column('way_north_m')[k])];
    if (from) {
      const way = [to[0] - from[0], to[1] - from[1]], squared = way[0] ** 2 + way[1] ** 2;
      const share = squared ? Math.min(Math.max(((atX - from[0]) * way[0] + (atY - from[1]) * way[1]) / squared, 0), 1) : 0;
      least = Math.min(least, Math.hypot(from[0] + share * way[0] - atX, from[1] + share * way[1] - atY));
    }
    from = to;
  }
  return least;
}

// A click into a plan or a plot along a segment.
function pick(plot, event) {
  const {left, top} = plot.box.getBoundingClientRect();
  const frame = nearestFrame(plot, event.clientX - left, event.clientY - top);
  if (frame === null) return;
  choose(frame);
  setCursor(frame);
  dockReadout(event.clientY);
}

function legendOfView() {
  const classes = column(page.views[view].column), gaps = column('gap');
  const isThere = (look) => look.is !== null || classes.includes(null);
  const {layers} = page.parts.find((part) => part.part === 'plan').plot;
  return legend([...looks(page.views[view]).filter(isThere).map((look) => ({...look, kind: 'line', width_px: 5.5})),
    ...layers.filter(({kind}) => kind === 'gaps' && gaps.includes(1)).map((layer) => ({...layer, kind: 'line'})), ...layers.filter(({kind}) => kind === 'dots')]);
}

// The network in plan view, with the choice of what colours it.
function networkElement(part) {
  const choices = page.views.map((each, i) => {
    const input = h('input', {type: 'radio', name: 'view', value: i, ...(i === view ? {checked: 'checked'} : {})});
    input.addEventListener('change', () => show(i));
    return h('label', {}, input, each.name);
  });
  return h('figure', {}, h('h2', {}, part.heading), h('fieldset', {class: 'views'}, h('legend', {}, 'Coloured by'), ...choices),
    h('div', {id: 'view-legend'}, ...legendOfView()), plotElement(part.plot),
    h('figcaption', {}, h('span', {id: 'view-caption'}, page.views[view].caption), ' ', part.caption));
}

function show(choice) {
  view = choice;
  document.getElementById('view-legend').replaceChildren(...legendOfView());
  document.getElementById('view-caption').textContent = page.views[view].caption;
  redrawPlan();
  colourStrips();
}

function redrawPlan() {
  for (const plot of plots.filter(({spec}) => spec.stretches)) {
    plot.chart.data.datasets = datasets(plot.spec);
    plot.chart.update('none');
  }
}

function shape(tag, attributes) {
  const node = document.createElementNS('http://www.w3.org/2000/svg', tag);
  for (const [name, value] of Object.entries(attributes)) node.setAttribute(name, value);
  return node;
}

// The cells of a segment, in lines of equal scale.
function strip(segment, perLine) {
  const count = segment.end - segment.first, lines = Math.ceil(count / perLine);
  const svg = shape('svg', {class: 'strip', viewBox: `0 0 ${perLine} ${lines}`, preserveAspectRatio: 'none'});
  svg.style.height = `${lines * LINE_PX}px`;
  for (let i = 0; i < count; ++i) {
    const x = i % perLine, y = Math.floor(i / perLine), frame = segment.first + i;
    svg.append(shape('rect', {class: 'cell', 'data-frame': frame, x: x + 0.04, y: y + 0.06, width: 0.92, height: CELL}));
    if (column('gap')[frame]) svg.append(shape('rect', {class: 'gap', x, y: y + BAR[0], width: 1, height: BAR[1]}));
  }
  const frameAt = (event) => event.target.dataset.frame === undefined ? null : +event.target.dataset.frame;
  svg.addEventListener('pointermove', (event) => {
    setCursor(frameAt(event));
    dockReadout(event.clientY);
  });
  svg.addEventListener('pointerleave', (event) => { if (event.pointerType !== 'touch') setCursor(null); });
  svg.addEventListener('click', (event) => { if (frameAt(event) !== null) choose(frameAt(event)); });
  return svg;
}

function stripsElement(part) {
  const perLine = Math.min(CELLS, Math.max(...page.segments.map(({first, end}) => end - first)));
  const rows = part.order.flatMap((index) => {
    const segment = page.segments[index];
    const name = h('button', {type: 'button'}, segment.name);
    name.addEventListener('click', () => choose(segment.first));
    return [name, strip(segment, perLine)];
  });
  const box = h('div', {class: 'strips', tabindex: 0, role: 'group', 'aria-label': part.heading}, ...rows);
  return h('figure', {}, h('h2', {}, part.heading), box, h('figcaption', {}, part.caption));
}

function colourStrips() {
  const colours = new Map(looks(page.views[view]).map((look) => [look.is, `var(--${look.colour})`]));
  const classes = column(page.views[view].column);
  for (const cell of document.querySelectorAll('.strip .cell')) {
    cell.style.fill = colours.get(classes[cell.dataset.frame]);
    cell.classList.toggle('chosen-cell', +cell.dataset.frame === chosen);
  }
}

// Brings the chosen cell into the box of the strips, without moving the page.
function scrollStrips() {
  const box = document.querySelector('.strips'), cell = document.querySelector('.chosen-cell');
  const [outer, inner] = [box.getBoundingClientRect(), cell.getBoundingClientRect()];
  if (inner.top < outer.top) box.scrollTop -= outer.top - inner.top + LINE_PX;
  if (inner.bottom > outer.bottom) box.scrollTop += inner.bottom - outer.bottom + LINE_PX;
}

// The plots and facts of the chosen segment.
function segmentElement(part) {
  const options = page.segments.map(({name}, i) => h('option', {value: i}, name));
  const select = h('select', {id: 'segment', 'aria-label': 'segment'}, ...options);
  select.addEventListener('change', () => choose(page.segments[select.value].first));
  const keys = part.plots.flatMap(({layers}) => layers.length > 1 ? layers : []);
  return h('figure', {}, h('h2', {}, part.heading), h('p', {class: 'choice'}, select), h('div', {id: 'segment-facts'}),
    ...legend([...keys, ...(page.segments.some(({gaps}) => gaps.length) ? [{kind: 'status', name: 'few landmarks'}] : [])]),
    h('div', {id: 'segment-plots'}), h('figcaption', {}, part.caption));
}

const factList = (facts) => h('dl', {}, ...facts.map(([name, value]) => h('div', {}, h('dt', {}, name), h('dd', {}, value))));

// The upper end of an axis that holds all values.
function topOf(axis, values) {
  const most = Math.max(axis.max, ...values.filter((value) => value !== null));
  if (axis.log) return roundStep(1.1 * most);
  const step = roundStep(most / 4);
  return step * Math.ceil(most / step - 1e-9);
}

// A plot of the part for one segment.
function plotAlong(template, {first, end, length_m: length, gaps}, label) {
  const slice = (name) => column(name).slice(first, end);
  const layers = template.layers.map((layer) => ({...layer, x: [...slice(layer.x), length], y: [...slice(layer.y), column(layer.y)[end - 1]]}));
  const y = template.y.grows ? {...template.y, max: topOf(template.y, layers.flatMap((layer) => layer.y))} : {...template.y};
  const lanes = gaps.length ? {lanes: [{marks: gaps.map(([from, to]) => [from, to, 'few landmarks'])}]} : {};
  return {...template, frames: [first, end], x: {label, min: 0, max: length, decimals: 0}, y, layers, ...lanes};
}

function drawAlong(segment) {
  const part = page.parts.find((each) => each.part === 'segment');
  for (const plot of plots.filter(({spec}) => Array.isArray(spec.frames))) {
    plot.chart.destroy();
    plots.splice(plots.indexOf(plot), 1);
  }
  const before = plots.length;
  document.getElementById('segment-plots').replaceChildren(...part.plots.map((template) => plotElement(plotAlong(template, segment, part.label))));
  for (const plot of plots.slice(before)) {
    draw(plot);
    listenTo(plot);
  }
}

// Shows a stretch and its segment everywhere.
function choose(frame) {
  const isOther = chosen === null || column('segment')[chosen] !== column('segment')[frame];
  chosen = frame;
  document.getElementById('segment').value = column('segment')[frame];
  document.getElementById('segment-facts').replaceChildren(factList(Object.entries(segmentOf(frame).facts)),
    h('h3', {}, `Chosen: ${spanOf(frame)}`),
    factList(page.frames.rows.map((row) => [row.name, row.values.map((of) => valueOf(of, frame)).join(', ')])));
  if (isOther) drawAlong(segmentOf(frame));
  redrawPlan();
  colourStrips();
  scrollStrips();
}
