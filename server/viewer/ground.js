// The map's ground: a plain one with a grid of round degrees, or the operator's tiles.

import * as L from './leaflet.js';

const LEAST_SPACING_PX = 120;
const STEPS_DEG = [30, 10, 5, 2, 1, 0.5, 0.2, 0.1, 0.05, 0.02, 0.01, 0.005, 0.002, 0.001, 0.0005, 0.0002, 0.0001, 0.00005, 0.00002];
const MAX_ZOOM = 23;

const dark = matchMedia('(prefers-color-scheme: dark)'), colours = new Map();
dark.addEventListener('change', () => colours.clear());

// A colour of the style sheet, as the scheme has it.
export function colour(name) {
  if (!colours.has(name)) colours.set(name, getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim());
  return colours.get(name);
}

// Calls back when the colours have become others.
export const onColours = (listener) => dark.addEventListener('change', listener);

// The smallest step whose lines are not too close, in degrees of longitude.
function stepAt(map) {
  const {lat, lng} = map.getCenter();
  const perDegree = map.latLngToContainerPoint([lat, lng + 1]).x - map.latLngToContainerPoint([lat, lng]).x;
  return STEPS_DEG.filter((step) => step * perDegree >= LEAST_SPACING_PX).at(-1) ?? STEPS_DEG[0];
}

function gridLines(bounds, step) {
  const lines = [];
  const [south, north] = [Math.max(bounds.getSouth(), -85), Math.min(bounds.getNorth(), 85)];
  for (let k = Math.floor(bounds.getWest() / step); k * step <= bounds.getEast(); ++k) lines.push([[south, k * step], [north, k * step]]);
  for (let k = Math.ceil(south / step); k * step <= north; ++k) lines.push([[k * step, bounds.getWest()], [k * step, bounds.getEast()]]);
  return lines;
}

// Leaflet's map on the element `id`; `tiles` is {url, attribution}, with an empty URL for a plain ground.
export function createMap(id, tiles) {
  const map = L.map(id, {
    preferCanvas: true, zoomControl: false, attributionControl: false, maxZoom: MAX_ZOOM, minZoom: 2, zoomSnap: 0.5, wheelPxPerZoomLevel: 90,
    fadeAnimation: false, zoomAnimation: !matchMedia('(prefers-reduced-motion: reduce)').matches,
  });
  map.setView([20, 0], 2);
  L.control.zoom({position: 'topright'}).addTo(map);
  L.control.scale({position: 'bottomright', imperial: false, maxWidth: 120}).addTo(map);
  if (tiles.url) {
    L.control.attribution({prefix: false}).addTo(map);
    const attribution = document.createElement('span');
    attribution.textContent = tiles.attribution;
    L.tileLayer(tiles.url, {attribution: attribution.innerHTML, maxZoom: MAX_ZOOM, maxNativeZoom: 19}).addTo(map);
    return map;
  }
  map.createPane('grid').style.zIndex = 250;
  const grid = L.layerGroup().addTo(map), renderer = L.canvas({pane: 'grid'});
  const draw = () => {
    grid.clearLayers();
    L.polyline(gridLines(map.getBounds().pad(0.2), stepAt(map)), {renderer, color: colour('grid'), weight: 1, interactive: false}).addTo(grid);
  };
  map.on('moveend', draw);
  onColours(draw);
  draw();
  return map;
}
