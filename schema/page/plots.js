// Plots: translates the layers of the data to the charting library. Layers are ordered from back to front.

const LEFT_PX = 52, RIGHT_PX = 20, AROUND_PX = 80;  // margins for axis labels
const LANE_PX = 9;
const STATUS = {  // styles that differ in more than colour
  initializing: {colour: 'muted', width_px: 5, opacity: 0.4}, predicted: {colour: 'muted', width_px: 2}, lost: {colour: 'ink', width_px: 5},
  'off-map': {colour: 'muted', width_px: 5, dash: [2, 3]}, tracking: {colour: 'm0', width_px: 5}, 'few landmarks': {colour: 'ink', width_px: 5},
};

const plots = [];  // {spec, box, canvas, chart}: all plots of the page

// A colour of the style sheet by its name.
function colour(name, opacity = 1) {
  const hex = getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim();
  return opacity < 1 ? hex.slice(0, 7) + Math.round(255 * opacity).toString(16).padStart(2, '0') : hex;
}

function points(xs, ys) {
  const y = column(ys);
  return column(xs).map((x, i) => ({x, y: x === null ? null : y[i]}));
}

function circle([x, y], radius) {
  return Array.from({length: 73}, (_, k) => k * Math.PI / 36).map((angle) => ({x: x + radius * Math.cos(angle), y: y + radius * Math.sin(angle)}));
}

function dataset(layer, data, more = {}) {
  const paint = colour(layer.colour, layer.opacity);
  const hasDots = layer.kind === 'dots' || layer.marker;
  return {
    layer, data, label: layer.name, fill: false, showLine: layer.kind !== 'dots', stepped: layer.steps || false, backgroundColor: paint,
    borderColor: paint, borderWidth: layer.width_px || 1.2, borderDash: layer.dash || [], borderJoinStyle: 'round',
    borderCapStyle: layer.dash ? 'butt' : 'round', pointRadius: hasDots ? layer.radius_px || 2 : 0, pointHoverRadius: hasDots ? layer.radius_px || 2 : 0,
    pointStyle: layer.marker || 'circle', pointRotation: layer.rotation_deg || 0, pointBorderColor: paint, pointBorderWidth: layer.edge_px || 0,
    pointBackgroundColor: colour(layer.fill || layer.colour, layer.opacity), ...(layer.unclipped ? {clip: false} : {}), ...more,
  };
}

// Points outside the y axis range as arrow heads at its edge.
function arrows(layer, data, y) {
  const beyond = data.filter((point) => point.y !== null && (point.y > y.max || point.y < y.min));
  return dataset({...layer, marker: 'triangle', radius_px: 4}, beyond.map(({x, y: at}) => ({x, y: at > y.max ? y.max : y.min})),
    {label: undefined, clip: 5, pointRotation: beyond.map((point) => point.y > y.max ? 0 : 180)});
}

const datasetsOf = {
  line: (layer) => [dataset(layer, layer.radius_m ? circle(layer.at, layer.radius_m) : points(layer.x, layer.y))],
  dots: (layer, spec) => {
    const data = points(layer.x, layer.y);
    return [...(layer.arrows ? [arrows(layer, data, spec.y)] : []), dataset(layer, data)];
  },
  area: (layer) => [dataset(layer, points(layer.x, layer.y), {borderWidth: 0, fill: 'start'})],
  band: (layer) => [
    dataset(layer, points(layer.x, layer.y), {borderWidth: 0, fill: '+1'}),
    dataset(layer, points(layer.x, layer.low || column(layer.y).map((value) => value === null ? null : -value)), {borderWidth: 0, label: undefined})],
  texts: () => [],
  stretches: (layer) => stretchLayers(layer).map((each) => dataset(each, ways(each.holds))),
  gaps: (layer) => [dataset(layer, ways((i) => column('gap')[i] === 1))],
  chosen: (layer) => chosenLayers(layer).map((each) => dataset(each, ways(each.holds))),
};

// The library draws the first dataset last. A pale edge makes a line legible on background images.
function datasets(spec) {
  return [...spec.layers].reverse().flatMap((layer) => {
    const own = datasetsOf[layer.kind](layer, spec);
    const pale = {label: undefined, borderColor: colour('page', 0.8), borderWidth: 5};
    return layer.cased ? [...own, ...own.map((each) => ({...each, ...pale}))] : own;
  });
}

function roundStep(least) {
  const power = 10 ** Math.floor(Math.log10(least));
  return power * [1, 2, 5, 10].find((each) => each * power >= least * 0.999);
}

// The tick spacing of both axes of a plan.
const planStep = (chart) => roundStep((chart.options.scales.x.max - chart.options.scales.x.min) / 7);

function ticks(built, axis, isPlan) {
  if (axis.names) return axis.names.map((_, value) => ({value}));
  if (axis.ticks) return axis.ticks.map((value) => ({value}));
  if (axis.log) return built.ticks.filter(({value}) => /^[125]e/.test((+value.toPrecision(6)).toExponential()));
  if (!isPlan) return built.ticks;
  const step = planStep(built.chart);
  const first = Math.ceil(built.min / step);
  return Array.from({length: Math.max(0, Math.floor(built.max / step) - first + 1)}, (_, k) => ({value: step * (first + k)}));
}

const lanesPx = (spec) => spec.lanes ? 4 + LANE_PX * spec.lanes.length : 0;

function scale(spec, which) {
  const axis = spec[which], isX = which === 'x';
  const lanes = isX ? lanesPx(spec) : 0;
  const text = function (value, index, all) {
    if (axis.names) return axis.names[value];
    return (axis.log ? String(+value.toPrecision(6)) : Chart.Ticks.formatters.numeric.call(this, value, index, all)).replace('-', '−');
  };
  return {
    type: axis.log ? 'logarithmic' : 'linear', min: axis.min, max: axis.max, title: {display: isX, text: axis.label, color: colour('muted')},
    grid: {drawTicks: false, borderColor: colour('grid'), color: ({tick}) => tick && tick.value === 0 && !spec.plan && !axis.names ? colour('muted', 0.55) : colour('grid')},
    ticks: {color: colour(axis.names ? 'ink' : 'muted'), padding: 6 + lanes, includeBounds: false, maxRotation: 0, autoSkip: !axis.names,
      maxTicksLimit: 9, callback: text},
    afterBuildTicks: (built) => { built.ticks = ticks(built, axis, spec.plan); },
    afterFit: (fitted) => {
      if (isX) Object.assign(fitted, {height: fitted.height - lanes, paddingLeft: 0, paddingRight: 0});  // the library would pad the lanes twice
      else if (!axis.names) fitted.width = LEFT_PX;
    },
  };
}

// The tooltip of plots that are not over frames.
function tooltip(spec) {
  return {
    enabled: !spec.frames && !spec.plan, filter: (item) => item.dataset.label,
    callbacks: {
      title: ([item]) => item && `${spec.x.names ? spec.x.names[item.parsed.x] : number(item.parsed.x, spec.x.decimals)}`
        + (spec.bin ? ` to ${number(item.parsed.x + spec.bin, spec.x.decimals)}` : '') + `, ${spec.x.label}`,
      label: ({dataset: {label, layer}, parsed}) => `${label}: ${spec.y.names ? spec.y.names[parsed.y] : number(parsed.y, spec.y.decimals)}`
        + (layer.total ? ` (${Math.round(parsed.y * layer.total / 100)} of ${layer.total})` : ''),
    },
  };
}

function configuration(spec) {
  return {
    type: 'line', data: {datasets: datasets(spec)}, plugins: [trimmings(spec)],
    options: {
      animation: false, maintainAspectRatio: false, locale: 'en-US', devicePixelRatio: Math.max(2, devicePixelRatio), font: {size: 12},
      events: spec.frames || spec.plan ? [] : ['mousemove', 'mouseout', 'touchstart', 'touchmove'], interaction: {mode: 'nearest', axis: 'x', intersect: false},
      layout: {padding: {right: spec.right_px || RIGHT_PX}},
      scales: {x: scale(spec, 'x'), y: scale(spec, 'y')},
      plugins: {
        legend: {display: false}, tooltip: tooltip(spec),
        title: {display: !!spec.y.label, text: spec.y.label, align: 'start', color: colour('muted'), font: {weight: 'normal'}, padding: {top: 8, bottom: 8}},
      },
    },
  };
}

// Drawn without the library: the background image of plans, texts, lanes, the scale bar and the north arrow.
function trimmings(spec) {
  return {
    beforeDatasetsDraw: (chart) => { if (spec.plan) drawPicture(chart); },
    afterDatasetsDraw: (chart) => {
      for (const layer of spec.layers) if (layer.kind === 'texts') drawTexts(chart, layer);
      (spec.lanes || []).forEach((lane, k) => drawLane(chart, lane, chart.chartArea.bottom + 5 + LANE_PX * (k + 0.5)));
      if (spec.plan) drawScaleAndNorth(chart);
    },
  };
}

const inside = ({left, right, top, bottom}, x, y) => x >= left - 1 && x <= right + 1 && y >= top - 1 && y <= bottom + 1;

function write(context, text, x, y, align) {
  Object.assign(context, {font: `600 12px ${getComputedStyle(document.body).fontFamily}`, textAlign: align, lineWidth: 3, lineJoin: 'round',
    strokeStyle: colour('page'), fillStyle: colour('ink')});
  context.strokeText(text, x, y);
  context.fillText(text, x, y);
}

function drawTexts({ctx, scales, chartArea}, layer) {
  layer.text.forEach((text, i) => {
    const x = scales.x.getPixelForValue(layer.x[i]), y = scales.y.getPixelForValue(layer.y[i]);
    if (layer.x[i] === null || !inside(chartArea, x, y)) return;
    const [right, down] = layer.shift_px || [0, 0];
    write(ctx, text, x + right, y + down, layer.align || 'left');
  });
}

function stroke(context, look, ...path) {
  context.save();
  Object.assign(context, {strokeStyle: colour(look.colour, look.opacity), lineWidth: look.width_px});
  context.setLineDash(look.dash || []);
  context.beginPath();
  path.forEach(([x, y], i) => i ? context.lineTo(x, y) : context.moveTo(x, y));
  context.stroke();
  context.restore();
}

function drawLane({ctx, scales: {x}, chartArea}, lane, y) {
  const {left, right} = chartArea;
  const within = (pixel) => Math.min(Math.max(pixel, left), right);
  if (lane.colour) {
    ctx.fillStyle = colour(lane.colour);
    ctx.fillRect(left - 13, y - 3, 6, 6);
  }
  for (const [begin, end, status] of lane.marks) {
    const from = x.getPixelForValue(begin), to = x.getPixelForValue(end);
    if (to >= left - 1 && from <= right + 1) stroke(ctx, STATUS[status], [within(from) - 2, y], [within(to) + 2, y]);
  }
}

let picture = null;

// The background image of plans; the matrix maps its unit square, y downwards, to metres east and north.
function loadPicture() {
  if (!page.ground || !page.ground.picture) return;
  picture = new Image();
  picture.onload = () => plots.forEach((plot) => plot.spec.plan && plot.chart.draw());
  picture.src = page.ground.picture.href;
}

function drawPicture({ctx, scales: {x, y}, chartArea: {left, top, right, bottom}}) {
  if (!picture || !picture.complete) return;
  const [a, b, c, d, e, f] = page.ground.picture.east_north_m;
  const pixel = (east, north) => [x.getPixelForValue(east), y.getPixelForValue(north)];
  const [origin, across, down] = [pixel(e, f), pixel(e + a, f + b), pixel(e + c, f + d)];
  ctx.save();
  ctx.beginPath();
  ctx.rect(left, top, right - left, bottom - top);
  ctx.clip();
  ctx.globalAlpha = 0.6;
  ctx.transform(across[0] - origin[0], across[1] - origin[1], down[0] - origin[0], down[1] - origin[1], ...origin);
  ctx.drawImage(picture, 0, 0, 1, 1);
  ctx.restore();
}

function drawScaleAndNorth(chart) {
  const {ctx, scales, chartArea: {left, right, top, bottom}} = chart;
  const step = planStep(chart);
  const length = step * (right - left) / (scales.x.max - scales.x.min);
  const x = right - 0.03 * (right - left), y = bottom - 20, north = [right - 20, top + 12];
  for (const look of [{colour: 'page', opacity: 0.8, width_px: 5}, {colour: 'ink', width_px: 2.5}]) {
    stroke(ctx, look, [x - length, y], [x, y]);
    stroke(ctx, look, [north[0], north[1] + 28], north);
    stroke(ctx, look, [north[0] - 5, north[1] + 8], north, [north[0] + 5, north[1] + 8]);
  }
  write(ctx, `${+step.toPrecision(6)} m`, x - length / 2, y - 7, 'center');
  write(ctx, 'N', north[0], north[1] + 43, 'center');
}
