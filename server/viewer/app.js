// The viewer: what is chosen, and what follows from it in the panel, on the map and in the address.

import * as address from './address.js';
import {isAborted} from './api.js';
import {Boxes, boundsOf} from './boxes.js';
import {rememberBuild} from './builds.js';
import {changesPart} from './changespanel.js';
import {classOf, colouringOf} from './colourings.js';
import * as documents from './documents.js';
import {h, position} from './dom.js';
import {follow} from './follow.js';
import {colour, createMap} from './ground.js';
import * as L from './leaflet.js';
import {replaceLegend} from './legend.js';
import {positionIn, wrappedLongitude} from './lines.js';
import {catalogPanel, mapPanel, nearPanel} from './mappanel.js';
import {metricsPanel} from './metricspanel.js';
import {Network} from './network.js';
import {forgetNews, tellNews, tellView} from './notices.js';
import {Places} from './places.js';
import {followPointer} from './readout.js';
import {segmentPanel, stretchText} from './segmentpanel.js';

const CLICK_PX = 16;
const SEARCH_RADIUS_M = 500;
const TYPING_MS = 150;
const MOST_DESCRIBED = 24;  // maps whose documents are read at once: those of the list

// How to bring bounds into view: beside the legend where that lies on the map.
const fit = (maxZoom = 18.5) => {
  const isBeside = matchMedia('(min-width: 62.01rem)').matches;
  return {paddingTopLeft: [isBeside ? 380 : 30, 40], paddingBottomRight: [isBeside ? 60 : 30, 40], maxZoom};
};

const byId = (id) => document.getElementById(id);
const setting = (name) => document.querySelector(`meta[name="${name}"]`).content;

const start = address.read();
const state = {maps: [], map: null, segment: null, found: null, colouring: colouringOf(start.colour)};

const map = createMap('map', {url: setting('tiles-url'), attribution: setting('tiles-attribution')});
const boxes = new Boxes(map);
const network = new Network(map, state.colouring, {changed: networkChanged, told: ({isTooWide, ...more}) => tellView({isTooWide: isTooWide && state.maps.length > 0, ...more}), failed});
const places = new Places(map, network, () => boxes.mayBeInView().filter(({document: {layers}}) => layers.includes('walls')).map(({of}) => of), failed);
const marker = L.circleMarker([0, 0], {radius: 7, weight: 3, fillOpacity: 0.2, interactive: false});

function failed(failure) {
  if (isAborted(failure)) return;
  if (failure.status === 410) readCatalog().catch(catalogFailed);
  else if (failure.status !== 0) tellNews(failure.message);
}

function networkChanged() {
  for (const {map: name, build, mapDocument} of network.segments.values()) boxes.add({map: name, build}, mapDocument);
  places.refresh();
  showLegend();
}

function showLegend() {
  const hasMissing = [...network.segments.values()].some(({stretches}) => stretches.some((stretch) => classOf(state.colouring, stretch) === null));
  replaceLegend(byId('legend'), {colouring: state.colouring, hasMissing, wanted: places.wanted, atZoom: map.getZoom()}, {
    choose: chooseColouring,
    want: (kind, isWanted) => {
      places.want(kind, isWanted);
      showLegend();
    },
  });
}

async function chooseColouring(colouring) {
  state.colouring = colouring;
  showLegend();
  await network.colourBy(colouring);
  showPanel();
  writeAddress();
}

// Promises a map's document, and draws its box.
async function describe(of) {
  const described = await documents.mapDocument(of);
  boxes.add(of, described);
  return described;
}

// Asynchronous panels show only if they are still wanted when they are ready.
let panelTurn = 0;
async function showPanel({toTop = false} = {}) {
  const turn = ++panelTurn;
  const nodes = await panelNodes().catch((failure) => [h('p', {class: 'empty'}, failure.message)]);
  if (turn !== panelTurn) return;
  const hadFocus = byId('content').contains(document.activeElement);
  byId('content').replaceChildren(...nodes);
  if (hadFocus) (byId('content').querySelector('h2') ?? byId('content').querySelector('button'))?.focus();
  if (toTop) byId('panel').scrollTop = 0;
  const title = state.segment?.segment ?? state.map?.map;
  document.title = title ? `${title} – milepost maps` : 'milepost maps';
}

async function panelNodes() {
  if (state.segment) return segmentPanel(state.segment, state.colouring, onSegment);
  if (state.found) return nearPanel(state.found.text, state.found.near, SEARCH_RADIUS_M, chooseSegment, chooseNothing);
  if (state.map) return mapPanelNodes(state.map);
  return catalogPanel(state.maps, positionIn(byId('query').value) ? '' : byId('query').value.trim(), chooseMap, describe);
}

async function mapPanelNodes(of) {
  const [described, paths] = await Promise.all([describe(of), documents.paths().catch(() => new Set())]);
  return mapPanel(of, described, paths.has('/v1/maps/{map}/changes') ? changesPart(of, onMap) : null, onMap);
}

const onSegment = {
  from: () => state.found ? `Near ${state.found.text}` : state.segment.map,
  back: () => (state.found ? clearSegment() : chooseMap(mapNamed(state.segment.map), {isFitted: false})),
  goTo: (from_m, to_m) => {
    map.fitBounds(network.boundsOf(state.segment, Math.max(from_m, 0), Math.min(to_m, state.segment.document.length_m)), fit(20));
    network.mark([from_m, to_m]);
  },
  mark: (range) => network.mark(range && [Math.max(range[0], 0), Math.min(range[1], state.segment.document.length_m)]),
  choose: ({map: name, segment}) => {
    const of = mapNamed(name || state.segment.map);
    return of ? chooseSegment({...of, segment}) : tellNews(`The server has no map ${name}.`);
  },
};

const onMap = {
  back: chooseNothing,
  choose: (segment) => chooseSegment({...state.map, segment}),
  record: () => documents.mapping(state.map),
  compare: async (from) => {
    const of = state.map, changes = await documents.changes(of, from);
    network.markChanged(of.map, changes.segments.map(({segment}) => segment));
    return changes;
  },
};

const mapNamed = (name) => state.maps.find((each) => each.map === name);

function clearSegment() {
  ++segmentTurn;
  state.segment = null;
  network.select(null);
  showPanel({toTop: true});
  writeAddress();
}

function chooseNothing() {
  Object.assign(state, {map: null, found: null});
  network.markChanged(null, []);
  marker.remove();
  clearSegment();
}

// The bounds of a map, or else of its first segment; null without any.
async function boundsOfMap(of) {
  const described = await describe(of), bounds = boundsOf(described, map.getCenter().lng);
  if (bounds || !described.segments.length) return bounds;
  return network.boundsOf(await loaded({...of, segment: described.segments[0]}));
}

async function chooseMap(of, {isFitted = true} = {}) {
  forgetNews();
  rememberBuild(of);
  if (state.map?.map !== of.map) network.markChanged(null, []);
  Object.assign(state, {map: of, found: null});
  clearSegment();
  if (!isFitted) return;
  try {
    const bounds = await boundsOfMap(of);
    if (bounds && state.map === of) map.fitBounds(bounds, fit());
  } catch (failure) {
    failed(failure);
  }
}

// A segment that is aborted was wanted by a search that the view has left: it is asked for again.
const loaded = (of) => network.load(of).catch((failure) => isAborted(failure) ? network.load(of) : Promise.reject(failure));

let segmentTurn = 0;
async function chooseSegment(of, {isFitted = true} = {}) {
  const turn = ++segmentTurn;
  forgetNews();
  try {
    const segment = await loaded({map: of.map, build: of.build, segment: of.segment});
    if (turn !== segmentTurn) return;  // another one was chosen meanwhile
    Object.assign(state, {segment, map: mapNamed(of.map)});
    network.place(segment, map.getCenter().lng);
    network.select(segment);
    if (isFitted) map.fitBounds(network.boundsOf(segment), fit());
    showPanel({toTop: true});
    writeAddress();
  } catch (failure) {
    failed(failure);
  }
}

async function search(text) {
  const at = positionIn(text);
  if (!at) return;
  map.setView(at, Math.max(map.getZoom(), 18));
  marker.setLatLng(at).setStyle({color: colour('m1')}).addTo(map);
  try {
    const near = await documents.segmentsNear(at, SEARCH_RADIUS_M);
    Object.assign(state, {found: {text: position(at.lat, at.lng), near}, map: null});
    clearSegment();
  } catch (failure) {
    failed(failure);
  }
}

function writeAddress() {
  const {lat, lng} = map.getCenter();
  address.write({view: {zoom: map.getZoom(), lat, lng: wrappedLongitude(lng)}, map: state.map?.map,
    segment: state.segment?.segment, colour: state.colouring === colouringOf(null) ? null : state.colouring.id});
}

// Reads which maps there are; those that were built anew or are gone are forgotten.
async function readCatalog() {
  const maps = (await documents.catalog()).map(({name, build}) => ({map: name, build}));
  const isSame = JSON.stringify(maps) === JSON.stringify(state.maps);
  if (isSame && byId('content').dataset.read) return;
  byId('content').dataset.read = 'true';
  state.maps = maps;
  const builds = new Map(maps.map((of) => [of.map, of.build]));
  network.keepOnly(builds);
  boxes.keepOnly(builds);
  const before = state.segment ?? state.map;
  state.map = before && (mapNamed(before.map) ?? null);
  if (before && builds.get(before.map) !== before.build) {
    clearSegment();
    tellNews(builds.has(before.map) ? `The map ${before.map} was built anew.` : `The map ${before.map} is no longer served.`);
  } else {
    showPanel();
  }
  network.later();
  Promise.all(maps.slice(0, MOST_DESCRIBED).map(describe)).then(() => places.refresh(), failed);
}

function catalogFailed(failure) {
  failed(failure);
  if (!byId('content').dataset.read) byId('content').replaceChildren(h('p', {class: 'empty'}, 'The catalog could not be read yet.'));
}

function listen() {
  const query = byId('query');
  let typing = null;
  query.addEventListener('input', () => {
    clearTimeout(typing);
    typing = setTimeout(() => { if (!positionIn(query.value)) chooseNothing(); }, TYPING_MS);
  });
  byId('search').addEventListener('submit', (event) => {
    event.preventDefault();
    search(query.value);
  });
  map.on('click', ({latlng}) => {
    const hit = network.at(latlng, CLICK_PX);
    if (hit) return chooseSegment(hit.segment, {isFitted: false});
    const of = map.getZoom() < 15 && boxes.at(latlng);
    if (of) chooseMap(of);
  });
  map.on('moveend', writeAddress);
  map.on('zoomend', showLegend);
  followPointer(map, byId('readout'), (latlng) => network.at(latlng, CLICK_PX), ({stretch}) => stretchText(state.colouring, stretch));
  document.addEventListener('keydown', (event) => {
    if (event.key === 'Escape') goBack();
  });
}

function goBack() {
  if (state.segment) onSegment.back();
  else if (state.found || state.map) chooseNothing();
}

// The first view is the address's, or the map's that it names, or that of all maps.
async function showFirst() {
  const of = start.map && mapNamed(start.map);
  if (start.view) map.setView(start.view, start.view.zoom);
  if (start.map && !of) tellNews(`The server has no map ${start.map}.`);
  if (of && start.segment) return chooseSegment({...of, segment: start.segment}, {isFitted: !start.view});
  if (of) return chooseMap(of, {isFitted: !start.view});
  if (start.view) return;
  const found = await Promise.all(state.maps.slice(0, MOST_DESCRIBED).map((each) => boundsOfMap(each).catch(() => null)));
  const all = found.filter(Boolean);
  if (all.length && !state.map) map.fitBounds(all.reduce((sum, bounds) => sum.extend(bounds), L.latLngBounds(all[0].getSouthWest(), all[0].getNorthEast())), fit());
}

listen();
showLegend();
await follow(() => readCatalog().catch(catalogFailed), {map: byId('map'), away: byId('away'), back: () => network.later()});
await showFirst();
writeAddress();
documents.paths().then((paths) => {
  if (paths.has('/metrics')) byId('server').replaceChildren(metricsPanel());
}, failed);
