// What is seen from near: the begins of tiles, landmarks, and walls.

import {isAborted} from './api.js';
import * as documents from './documents.js';
import {h} from './dom.js';
import {colour, onColours} from './ground.js';
import * as L from './leaflet.js';
import {besides, nearLongitude, pointAt} from './lines.js';
import {LANDMARKS} from './stretches.js';

export const KINDS = [
  {id: 'tiles', name: 'tiles', zoom: 17},
  {id: 'landmarks', name: 'landmarks', zoom: 18},
  {id: 'walls', name: 'walls', zoom: 15},
];
const MOST_TILES = 40;  // of landmarks, in one view
const MOST_CELLS = 40;
const MOST_MARKS = 150;
const HALF_MARK_M = 2.5;
const NUMBERS_ZOOM = 18;  // from here on the begins of tiles have numbers

const radiusAt = (zoom) => zoom < 19 ? 1.6 : zoom < 20 ? 2.4 : 3.2;

export class Places {
  // `mapsInView()` gives [{map, build}], those with walls.
  constructor(map, network, mapsInView, failed) {
    Object.assign(this, {map, network, mapsInView, failed, wanted: new Set(['tiles', 'landmarks', 'walls']), turn: 0});
    this.groups = {};
    for (const [kind, zIndex] of [['walls', 400], ['tiles', 435], ['landmarks', 405]]) {
      map.createPane(kind).style.zIndex = zIndex;
      this.groups[kind] = {group: L.layerGroup().addTo(map), renderer: L.canvas({pane: kind, padding: 0.2}), shown: ''};
    }
    map.on('moveend', () => this.refresh());
    onColours(() => this.redraw());
  }

  redraw() {
    for (const kind of Object.values(this.groups)) kind.shown = '';
    this.refresh();
  }

  want(kind, isWanted) {
    this.wanted[isWanted ? 'add' : 'delete'](kind);
    this.refresh();
  }

  shows(kind) {
    return this.wanted.has(kind) && this.map.getZoom() >= KINDS.find(({id}) => id === kind).zoom;
  }

  // Draws what comes of a kind, unless the view has moved on meanwhile or nothing changed.
  async fill(kind, turn, items, load, draw) {
    const {group} = this.groups[kind];
    const shown = items.map(({key}) => key).join(' ');
    if (shown === this.groups[kind].shown) return;
    const loaded = await Promise.all(items.map(load));
    if (turn !== this.turn) return;
    this.groups[kind].shown = shown;
    group.clearLayers();
    items.forEach((item, i) => draw(item, loaded[i]));
  }

  async refresh() {
    const turn = ++this.turn, {lng} = this.map.getCenter();
    try {
      await Promise.all([
        this.fill('tiles', turn, this.shows('tiles') ? this.tileBegins() : [], () => null, (mark) => this.drawTile(mark)),
        this.fill('landmarks', turn, this.shows('landmarks') ? this.landmarkTiles() : [],
          ({segment, tile}) => documents.landmarks(segment, tile.index), (_, landmarks) => this.drawLandmarks(landmarks, lng)),
        this.wallCells(turn).then((cells) => this.fill('walls', turn, cells, ({of, cell}) => documents.walls(of, cell.cell),
          (_, walls) => this.drawWalls(walls, lng))),
      ]);
    } catch (failure) {
      if (!isAborted(failure)) this.failed(failure);
    }
  }

  // The begin of each tile of landmarks in view.
  tileBegins() {
    const bounds = this.map.getBounds(), isNumbered = this.map.getZoom() >= NUMBERS_ZOOM, marks = [];
    for (const segment of this.network.inView()) {
      const length_m = segment.mapDocument.layer_parameters[LANDMARKS]?.tile_length_m;
      for (const tile of length_m ? segment.document.tiles[LANDMARKS] ?? [] : []) {
        const along_m = tile.index * length_m, {lat, lng} = pointAt(segment.line, along_m);
        if (along_m < segment.document.length_m && bounds.contains([lat, lng + segment.offset_deg])) {
          marks.push({key: `${segment.key}/${tile.index}@${segment.offset_deg}/${isNumbered}`, segment, tile, along_m, isNumbered});
        }
      }
    }
    return marks.slice(0, MOST_MARKS);
  }

  drawTile({segment, tile, along_m, isNumbered}) {
    const {group, renderer} = this.groups.tiles;
    const end = (right_m) => {
      const {lat, lng} = besides(segment.line, along_m, right_m);
      return [lat, lng + segment.offset_deg];
    };
    L.polyline([end(-HALF_MARK_M), end(HALF_MARK_M)], {renderer, color: colour('ink'), weight: 1.5, interactive: false}).addTo(group);
    if (!isNumbered) return;
    const icon = L.divIcon({className: 'tile-label', iconSize: null, html: h('span', {}, String(tile.index))});
    L.marker(end(HALF_MARK_M), {icon, interactive: false, keyboard: false, pane: 'tiles'}).addTo(group);
  }

  // The tiles whose landmarks were seen from a place in view, the middle's first.
  landmarkTiles() {
    const bounds = this.map.getBounds(), centre = this.map.getCenter(), radius = radiusAt(this.map.getZoom()), tiles = [];
    for (const segment of this.network.inView()) {
      for (const tile of segment.document.tiles[LANDMARKS] ?? []) {
        const range = this.network.boundsOf(segment, Math.max(tile.from_m, 0), Math.min(tile.to_m, segment.document.length_m));
        if (bounds.intersects(range)) tiles.push({key: `${segment.key}/${tile.index}@${radius}`, segment, tile, far_m: centre.distanceTo(range.getCenter())});
      }
    }
    return tiles.sort((a, b) => a.far_m - b.far_m).slice(0, MOST_TILES);
  }

  drawLandmarks(landmarks, longitude) {
    const {group, renderer} = this.groups.landmarks, fillColor = colour('m1'), radius = radiusAt(this.map.getZoom());
    for (const [lat, lng] of landmarks) {
      L.circleMarker([lat, nearLongitude(lng, longitude)],
        {renderer, radius, stroke: false, fillColor, fillOpacity: 0.7, interactive: false}).addTo(group);
    }
  }

  async wallCells(turn) {
    if (!this.shows('walls')) return [];
    const bounds = this.map.getBounds(), {lng} = this.map.getCenter(), cells = [];
    for (const of of this.mapsInView()) {
      for (const cell of await documents.wallCells(of)) {
        const offset_deg = nearLongitude(cell.west_deg, lng) - cell.west_deg;
        const box = L.latLngBounds([cell.south_deg, cell.west_deg + offset_deg], [cell.north_deg, cell.east_deg + offset_deg]);
        if (bounds.intersects(box)) cells.push({key: `${of.map}/${of.build}/${cell.cell}`, of, cell});
      }
    }
    return turn === this.turn ? cells.slice(0, MOST_CELLS) : [];
  }

  drawWalls(walls, longitude) {
    const {group, renderer} = this.groups.walls;
    const lines = walls.map(([lat, lng, endLat, endLng]) => {
      const start = nearLongitude(lng, longitude);
      return [[lat, start], [endLat, nearLongitude(endLng, start)]];
    });
    L.polyline(lines, {renderer, color: colour('wall'), weight: 1.75, lineCap: 'round', interactive: false}).addTo(group);
  }
}
