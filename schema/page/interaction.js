// Interaction: one cursor and one zoom for all plots over frames, and an independent view for each plan.

const LEAST_DRAG_PX = 4;
const NEAR_PX = 24;        // distance to a frame on a plan
const SCROLLING_MS = 400;  // after scrolling the page, the mouse wheel does not zoom
let cursor = null;         // number of a frame
let scrolled = -Infinity;

// Keeps ticks at the ends despite rounding.
function widen(axis) {
  const margin = axis.log ? 0 : 1e-9 * (axis.max - axis.min);
  if (margin) Object.assign(axis, {min: axis.min - margin, max: axis.max + margin});
}

function plotElement(spec) {
  widen(spec.x);
  widen(spec.y);
  const canvas = h('canvas', {role: 'img', 'aria-label': spec.description});
  const box = h('div', {class: spec.plan ? 'plot plan' : 'plot', tabindex: 0}, h('div', {class: 'canvas'}, canvas));
  box.firstChild.style.height = `${(spec.height_px || 200) + AROUND_PX + lanesPx(spec)}px`;
  for (const name of ['cursor', 'here', 'chosen']) box.append(h('div', {class: name, hidden: 'hidden'}));
  const plot = {spec, box, canvas, chart: null};
  plots.push(plot);
  const heading = spec.title ? [h('h3', {}, spec.title)] : [];
  return h('div', {}, ...heading, box);
}

const range = ({chart}, which) => [chart.scales[which].min, chart.scales[which].max];

function setRange(plot, which, [min, max]) {
  Object.assign(plot.chart.options.scales[which], {min, max});
}

// Hides a line with more visible points than its layer allows; its dots remain.
function update(plot) {
  const [from, to] = [plot.chart.options.scales.x.min, plot.chart.options.scales.x.max];
  for (const each of plot.chart.data.datasets) {
    if (!each.layer.most_points) continue;
    each.hidden = each.data.filter(({x}) => x !== null && x >= from && x <= to).length > each.layer.most_points;
  }
  plot.chart.update('none');
  showCursor(plot);
}

// The plots that zoom together.
const together = (plot) => plot.spec.frames ? plots.filter((each) => each.spec.frames) : [plot];

function zoomTo(plot, rangeX, rangeY) {
  for (const each of together(plot)) {
    setRange(each, 'x', rangeX);
    if (rangeY) setRange(each, 'y', rangeY);
    update(each);
  }
}

function reset(plot) {
  for (const each of together(plot)) {
    for (const which of ['x', 'y']) setRange(each, which, [each.spec[which].min, each.spec[which].max]);
    update(each);
  }
}

// Zooms around a point given as a share of the width, and of the height of a plan.
function zoomBy(plot, factor, shareX = 0.5, shareY = 0.5) {
  const about = ([from, to], share) => [from + (to - from) * share * (1 - factor), to - (to - from) * (1 - share) * (1 - factor)];
  zoomTo(plot, about(range(plot, 'x'), shareX), plot.spec.plan && about(range(plot, 'y'), shareY));
}

function moveBy(plot, rightPx, downPx) {
  const {width, height} = plot.chart.chartArea;
  const moved = ([from, to], share) => [from + (to - from) * share, to + (to - from) * share];
  zoomTo(plot, moved(range(plot, 'x'), -rightPx / width), moved(range(plot, 'y'), downPx / height));
}

// Whether a plot is over this frame; one along a segment is only over some.
const covers = (spec, frame) => !Array.isArray(spec.frames) || (frame >= spec.frames[0] && frame < spec.frames[1]);

// The position of a frame in a plot, in pixels; null if it is not visible.
function place({spec, chart: {scales: {x, y}, chartArea}}, frame) {
  if (!covers(spec, frame)) return null;
  const at = column(spec.plan ? page.frames.east : page.frames.x)[frame];
  const north = spec.plan ? column(page.frames.north)[frame] : null;
  if (at === null || at === undefined || (spec.plan && north === null)) return null;
  const pixel = [x.getPixelForValue(at), spec.plan ? y.getPixelForValue(north) : chartArea.top];
  return inside(chartArea, ...pixel) ? pixel : null;
}

function nearestFrame(plot, x, y) {
  let best = null, least = plot.spec.plan ? NEAR_PX : Infinity;
  for (let frame = 0; frame < column(page.frames.x).length; ++frame) {
    const at = place(plot, frame);
    if (!at && !plot.spec.stretches) continue;
    const distance = plot.spec.stretches ? distanceToWay(plot, frame, x, y)
      : plot.spec.plan ? Math.hypot(at[0] - x, at[1] - y) : Math.abs(at[0] - x);
    if (distance < least) [best, least] = [frame, distance];
  }
  return best;
}

function showCursor(plot) {
  if (!plot.spec.frames && !plot.spec.plan) return;
  const mark = plot.box.querySelector(plot.spec.plan ? '.here' : '.cursor');
  const at = cursor === null ? null : place(plot, cursor);
  mark.hidden = !at;
  if (!at) return;
  Object.assign(mark.style, {left: `${at[0]}px`, top: `${at[1]}px`});
  if (plot.spec.frames) mark.style.height = `${plot.chart.chartArea.height}px`;
}

function setCursor(frame) {
  if (cursor === frame) return;
  cursor = frame;
  plots.forEach(showCursor);
  const readout = document.getElementById('readout');
  readout.hidden = frame === null;
  if (frame !== null) readout.replaceChildren(...readoutOf(frame));
}

// Docks the readout to the bottom of the window, or to its top if it would cover the plot.
function dockReadout(clientY) {
  const readout = document.getElementById('readout');
  readout.classList.toggle('above', clientY > innerHeight - readout.offsetHeight - 60);
}

// The values of each method for a frame.
function readoutOf(frame) {
  const {label, x, decimals, unit, names, rows} = page.frames;
  const heads = rows[0].values.map((of) => h('th', {scope: 'col'}, of.label));
  const title = page.segments ? titleOf(frame) : `${column(names)[frame]}, ${label} ${number(column(x)[frame], decimals)} ${unit}`;
  return [h('p', {}, title),
    h('table', {}, ...(page.segments ? [] : [h('thead', {}, h('tr', {}, h('td'), ...heads))]), h('tbody', {}, ...rows.map((row) =>
      h('tr', {}, h('th', {scope: 'row'}, ...(row.colour ? [sample({kind: 'line', colour: row.colour})] : []), row.name),
        ...row.values.map((of) => h('td', {}, valueOf(of, frame)))))))];
}

// A value of the readout as text.
function valueOf(of, frame) {
  const raw = column(of.column)[frame];
  if (of.words) return raw === null ? '–' : of.words[raw];
  return number(raw, of.decimals, of.signed) + (raw === null || !of.unit ? '' : ` ${of.unit}`);
}

function hover(plot, event) {
  const {left, top} = plot.box.getBoundingClientRect();
  setCursor(nearestFrame(plot, event.clientX - left, event.clientY - top));
  dockReadout(event.clientY);
}

// Dragging moves a plan, and selects a range of other plots.
function listenToPointer(plot) {
  const {box, spec} = plot;
  const chosen = box.querySelector('.chosen');
  let start = null, last = null, moved = false;
  const offset = (event) => event.clientX - box.getBoundingClientRect().left;
  const stretch = (event) => [Math.min(start.x, offset(event)), Math.max(start.x, offset(event))];
  box.addEventListener('pointerdown', (event) => {
    if (event.button !== 0 || event.target.closest('button')) return;
    start = {x: offset(event), clientX: event.clientX, clientY: event.clientY};
    last = event;
    moved = false;
    box.setPointerCapture(event.pointerId);
  });
  box.addEventListener('pointermove', (event) => {
    moved = moved || (start && Math.hypot(event.clientX - start.clientX, event.clientY - start.clientY) >= LEAST_DRAG_PX);
    if (start && spec.plan && !moved) return;
    if (start && spec.plan) {
      moveBy(plot, event.clientX - last.clientX, event.clientY - last.clientY);
    } else if (start) {
      const [from, to] = stretch(event), {chartArea: {top, height}} = plot.chart;
      chosen.hidden = to - from < LEAST_DRAG_PX;
      Object.assign(chosen.style, {left: `${from}px`, width: `${to - from}px`, top: `${top}px`, height: `${height}px`});
    }
    last = event;
    if (spec.frames || spec.plan) hover(plot, event);
  });
  box.addEventListener('pointerup', (event) => {
    const {scales: {x}, chartArea} = plot.chart;
    if (start && !chosen.hidden) {
      zoomTo(plot, stretch(event).map((pixel) => x.getValueForPixel(Math.min(Math.max(pixel, chartArea.left), chartArea.right))));
    }
    if (start && !moved && page.segments) pick(plot, event);
    chosen.hidden = true;
    start = null;
  });
  box.addEventListener('pointercancel', () => { chosen.hidden = true; start = null; });
  box.addEventListener('pointerleave', (event) => { if (!page.segments || event.pointerType !== 'touch') setCursor(null); });
  box.addEventListener('dblclick', () => reset(plot));
}

function listenToWheel(plot) {
  plot.box.addEventListener('wheel', (event) => {
    if (event.timeStamp - scrolled < SCROLLING_MS) return;
    event.preventDefault();
    const {left, top} = plot.box.getBoundingClientRect();
    const {chartArea} = plot.chart;
    zoomBy(plot, 1.2 ** Math.sign(event.deltaY), (event.clientX - left - chartArea.left) / chartArea.width,
      (chartArea.bottom - (event.clientY - top)) / chartArea.height);
  }, {passive: false});
}

// Arrow keys move the cursor, or a plan; + and - zoom, Escape resets.
function listenToKeys(plot) {
  const step = (frames) => {
    const [first, end] = Array.isArray(plot.spec.frames) ? plot.spec.frames : [0, column(page.frames.x).length];
    setCursor(Math.min(Math.max(cursor === null ? first : cursor + frames, first), end - 1));
    dockReadout(plot.box.getBoundingClientRect().bottom);
  };
  const arrow = (right, down) => {
    if (plot.spec.plan) return moveBy(plot, -40 * right, -40 * down);
    return plot.spec.frames && right ? step(right) : false;
  };
  const keys = {
    ArrowLeft: () => arrow(-1, 0), ArrowRight: () => arrow(1, 0), ArrowUp: () => arrow(0, -1),
    ArrowDown: () => arrow(0, 1), '+': () => zoomBy(plot, 0.5), '-': () => zoomBy(plot, 2),
    Escape: () => { reset(plot); setCursor(null); },
  };
  plot.box.addEventListener('keydown', (event) => {
    if (!keys[event.key] || event.ctrlKey || event.altKey || event.metaKey) return;
    if (keys[event.key]() !== false) event.preventDefault();
  });
}

function addButtons(plot) {
  const button = (text, title, act) => {
    const node = h('button', {type: 'button', title, 'aria-label': title}, text);
    node.addEventListener('click', act);
    return node;
  };
  plot.box.append(h('div', {class: 'buttons'}, button('+', 'zoom in', () => zoomBy(plot, 0.5)), button('−', 'zoom out', () => zoomBy(plot, 2)),
    button('◻', 'reset', () => reset(plot))));
}

// Sets the height of a plan so that both axes have the same scale.
function fit({spec, box, chart}) {
  const {width, height} = chart.chartArea;
  const missing = width * (spec.y.max - spec.y.min) / (spec.x.max - spec.x.min) - height;
  if (Math.abs(missing) < 0.5) return;
  box.firstChild.style.height = `${box.firstChild.clientHeight + missing}px`;
  chart.resize();
}

function draw(plot) {
  const ranges = plot.chart && [range(plot, 'x'), range(plot, 'y')];
  if (plot.chart) plot.chart.destroy();
  plot.chart = new Chart(plot.canvas, configuration(plot.spec));
  if (ranges) ['x', 'y'].forEach((which, k) => setRange(plot, which, ranges[k]));
  if (plot.spec.plan) fit(plot);
  update(plot);
}

const drawAll = () => plots.forEach(draw);

function listenTo(plot) {
  listenToPointer(plot);
  listenToKeys(plot);
  if (!plot.spec.plan) return;
  listenToWheel(plot);
  addButtons(plot);
  new ResizeObserver(() => { plot.chart.resize(); fit(plot); showCursor(plot); }).observe(plot.box);
}

function onPaper(isOn) {
  document.documentElement.classList.toggle('paper', isOn);
  drawAll();
}

function start() {
  Chart.defaults.font.family = getComputedStyle(document.body).fontFamily;
  document.getElementById('page').append(head(), ...page.parts.map(shown));
  drawAll();
  loadPicture();
  plots.forEach(listenTo);
  if (page.segments) choose(page.segments[page.parts.find((part) => part.part === 'strips').order[0]].first);
  addEventListener('resize', () => plots.forEach(showCursor));
  addEventListener('scroll', (event) => { scrolled = event.timeStamp; setCursor(null); });
  matchMedia('(prefers-color-scheme: dark)').addEventListener('change', drawAll);
  addEventListener('beforeprint', () => onPaper(true));
  addEventListener('afterprint', () => onPaper(false));
}

start();
