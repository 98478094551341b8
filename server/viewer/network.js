// The network in view: asks which segments are near, loads their documents and draws them.

import {isAborted} from './api.js';
import {colourName, runsOf} from './colourings.js';
import * as documents from './documents.js';
import {colour, onColours} from './ground.js';
import * as L from './leaflet.js';
import {distance, lineOf, nearestOn, nearLongitude, partOf, pointAt, wrappedLongitude} from './lines.js';
import {stretchesOf} from './stretches.js';

const MOST_SEGMENTS = 300;  // that are loaded for one view
const MOST_KEPT = 600;
const FARTHEST_M = 10_000;  // that the server searches
const SETTLE_MS = 120;

const keyOf = ({map, build, segment}) => `${map}/${build}/${segment}`;

const widthAt = (zoom) => zoom < 13 ? 2.5 : zoom < 15.5 ? 4 : zoom < 18 ? 6 : 8;

// A segment's vertices on the plane of Web Mercator at zoom 0, for distances on the screen.
const onPlane = (line) => line.map(({lat, lng}) => L.CRS.EPSG3857.latLngToPoint(L.latLng(lat, lng), 0));

export class Network {
  // `on` has functions: changed() after the drawn segments changed, told({total, shown, isTooWide}) after each search,
  // failed(failure).
  constructor(map, colouring, on) {
    Object.assign(this, {map, colouring, on, panes: {}, segments: new Map(), changed: {map: null, ids: new Set()}, chosen: null, chosenLayers: [], marked: null, search: null, timer: null, width_px: widthAt(map.getZoom())});
    for (const [pane, zIndex] of [['changed', 408], ['selected', 410], ['casing', 420], ['lines', 430], ['marks', 440]]) {
      map.createPane(pane).style.zIndex = zIndex;
      this.panes[pane] = {group: L.layerGroup().addTo(map), renderer: L.canvas({pane, padding: 0.3})};
    }
    this.layers = new Map();
    map.on('moveend', () => this.later());
    map.on('zoomend', () => { if (widthAt(map.getZoom()) !== this.width_px) this.redraw(); });
    onColours(() => this.redraw());
  }

  later() {
    clearTimeout(this.timer);
    this.timer = setTimeout(() => this.refresh(), SETTLE_MS);
  }

  // Searches what is in view, and loads it.
  async refresh() {
    this.search?.abort();
    const {signal} = this.search = new AbortController();
    const centre = this.map.getCenter(), radius_m = distance(centre, this.map.getBounds().getNorthEast());
    this.moveToView(centre);
    if (radius_m > FARTHEST_M) return this.on.told({isTooWide: true});
    try {
      const at = {lat: centre.lat, lng: wrappedLongitude(centre.lng)};
      const near = await documents.segmentsNear(at, Math.max(radius_m, 1).toFixed(1), signal);
      const wanted = near.slice(0, MOST_SEGMENTS);
      this.on.told({total: near.length, shown: wanted.length});
      await Promise.all(wanted.map((of) => this.load(of, signal)));
      this.forget(new Set(wanted.map(keyOf)));
      this.on.changed();
    } catch (failure) {
      if (!isAborted(failure)) this.on.failed(failure);
    }
  }

  // The segment, loaded if need be. `signal` is the search's: another one goes on with what is still wanted.
  async load(of, signal) {
    const key = keyOf(of), known = this.segments.get(key), {needsMapping} = this.colouring;
    if (known) return known;
    const [document, map] = await Promise.all([documents.segmentDocument(of, signal), documents.mapDocument(of)]);
    const record = needsMapping ? await documents.mapping(of) : null;
    const segment = {...of, key, document, mapDocument: map, line: lineOf(document), offset_deg: 0};
    segment.stretches = stretchesOf(document, map, record?.fits.get(of.segment) ?? []);
    segment.hasRecord = Boolean(needsMapping);
    this.segments.set(key, segment);
    this.place(segment, this.map.getCenter().lng);
    this.draw(segment);
    return segment;
  }

  // Forgets the oldest segments that are not in view.
  forget(wanted) {
    for (const [key, segment] of this.segments) {
      if (this.segments.size <= MOST_KEPT) return;
      if (!wanted.has(key) && segment !== this.chosen) this.remove(key);
    }
  }

  remove(key) {
    for (const layer of this.layers.get(key) ?? []) layer.remove();
    this.layers.delete(key);
    this.segments.delete(key);
  }

  // Forgets the segments of maps that were replaced; `builds`: name -> build.
  keepOnly(builds) {
    for (const [key, {map, build}] of this.segments) if (builds.get(map) !== build) this.remove(key);
  }

  // The copy of the world in which a segment is drawn is the one nearest to the view.
  place(segment, longitude) {
    const offset_deg = nearLongitude(segment.line[0].lng, longitude) - segment.line[0].lng;
    if (segment.plane && offset_deg === segment.offset_deg) return false;
    segment.offset_deg = offset_deg;
    segment.plane = onPlane(segment.line.map((vertex) => ({...vertex, lng: vertex.lng + offset_deg})));
    return true;
  }

  moveToView({lng}) {
    for (const segment of this.segments.values()) if (this.place(segment, lng)) this.draw(segment);
    this.drawChosen();
  }

  async colourBy(colouring) {
    this.colouring = colouring;
    if (colouring.needsMapping) {
      const missing = [...this.segments.values()].filter(({hasRecord}) => !hasRecord);
      await Promise.all(missing.map(async (segment) => {
        const record = await documents.mapping(segment);
        segment.stretches = stretchesOf(segment.document, segment.mapDocument, record?.fits.get(segment.segment) ?? []);
        segment.hasRecord = true;
      })).catch(this.on.failed);
    }
    this.redraw();
    this.on.changed();
  }

  // Marks the segments of a map with these ids as changed.
  markChanged(map, ids) {
    if (ids.length || this.changed.ids.size) {
      this.changed = {map, ids: new Set(ids)};
      this.redraw();
    }
  }

  latLngs(segment, from_m, to_m) {
    return partOf(segment.line, from_m, to_m).map(({lat, lng}) => [lat, lng + segment.offset_deg]);
  }

  draw(segment) {
    for (const layer of this.layers.get(segment.key) ?? []) layer.remove();
    const weight = this.width_px, layers = [];
    const add = (pane, latLngs, options) =>
      layers.push(L.polyline(latLngs, {renderer: this.panes[pane].renderer, interactive: false, lineCap: 'butt', ...options}).addTo(this.panes[pane].group));
    if (this.changed.map === segment.map && this.changed.ids.has(segment.segment)) {
      add('changed', this.latLngs(segment, 0, segment.document.length_m), {color: colour('m2'), weight: weight + 14, opacity: 0.6, lineCap: 'round'});
    }
    add('casing', this.latLngs(segment, 0, segment.document.length_m), {color: colour('page'), weight: weight + 2.5, lineCap: 'round'});
    for (const run of runsOf(this.colouring, segment.stretches)) {
      add('lines', this.latLngs(segment, run.from_m, run.to_m), {color: colour(colourName(this.colouring, run.class)), weight});
    }
    this.layers.set(segment.key, layers);
  }

  redraw() {
    this.width_px = widthAt(this.map.getZoom());
    for (const segment of this.segments.values()) this.draw(segment);
    this.drawChosen();
  }

  select(segment) {
    this.chosen = segment;
    this.marked = null;
    this.drawChosen();
  }

  // Marks a part of the chosen segment; null ends it.
  mark(range) {
    this.marked = range;
    this.drawChosen();
  }

  drawChosen() {
    this.chosenLayers.forEach((layer) => layer.remove());
    this.chosenLayers = [];
    const segment = this.chosen;
    if (!segment) return;
    const ink = colour('ink'), page = colour('page'), weight = this.width_px, {length_m} = segment.document;
    const line = (pane, latLngs, options) => this.chosenLayers.push(
      L.polyline(latLngs, {renderer: this.panes[pane].renderer, interactive: false, color: ink, ...options}).addTo(this.panes[pane].group));
    line('selected', this.latLngs(segment, 0, length_m), {weight: weight + 8});
    if (this.marked) line('marks', this.latLngs(segment, ...this.marked), {weight: Math.max(2, weight / 2), lineCap: 'butt'});
    const dot = (along_m, options) => {
      const {lat, lng} = pointAt(segment.line, along_m);
      this.chosenLayers.push(L.circleMarker([lat, lng + segment.offset_deg],
        {renderer: this.panes.marks.renderer, interactive: false, color: ink, fillOpacity: 1, weight: 2, ...options}).addTo(this.panes.marks.group));
    };
    dot(0, {radius: weight / 2 + 3, fillColor: page});
    dot(length_m, {radius: weight / 2 + 3, fillColor: ink});
  }

  // The segment within `most_px` of a place on the map, and where along it: {segment, along_m, stretch}; null without one.
  at(latLng, most_px) {
    const scale = 2 ** this.map.getZoom(), at = L.CRS.EPSG3857.latLngToPoint(latLng, 0);
    let best = null;
    for (const segment of this.segments.values()) {
      const near = nearestOn(segment.plane, at);
      if (near.distance * scale > most_px || (best && best.near.distance <= near.distance)) continue;
      best = {segment, near};
    }
    if (!best) return null;
    const {segment, near: {index, share}} = best, [from, to] = [segment.line[index], segment.line[index + 1]];
    const along_m = from.along_m + share * (to.along_m - from.along_m);
    const stretch = segment.stretches.find(({to_m}) => along_m <= to_m) ?? segment.stretches.at(-1);
    return {segment, along_m, stretch};
  }

  boundsOf(segment, from_m = 0, to_m = segment.document.length_m) {
    return L.latLngBounds(this.latLngs(segment, from_m, to_m));
  }

  inView() {
    const bounds = this.map.getBounds();
    return [...this.segments.values()].filter((segment) => bounds.intersects(this.boundsOf(segment)));
  }
}
