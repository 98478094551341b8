// The maps whose documents are known, and their boxes on the map when it is seen from afar.

import {h} from './dom.js';
import {colour, onColours} from './ground.js';
import * as L from './leaflet.js';
import {nearLongitude} from './lines.js';

const SMALL_PX = 24;  // a box below this is drawn as a circle
const CIRCLE_PX = 12;
const NAME_PX = {width: 110, height: 22};  // the least distances of two names
const NEAR_ZOOM = 15;

const keyOf = ({map, build}) => `${map}/${build}`;

// A map's bounds in the copy of the world nearest to a longitude; null for a map of nothing, and for one across longitude
// 180, whose numbers lie around the world.
export function boundsOf({bounds: {west_deg, south_deg, east_deg, north_deg}}, longitude) {
  const isNothing = west_deg === 0 && east_deg === 0 && south_deg === 0 && north_deg === 0;
  if (isNothing || east_deg - west_deg > 180) return null;
  const west = nearLongitude(west_deg, longitude), east = west + (east_deg - west_deg + (west_deg > east_deg ? 360 : 0));
  return L.latLngBounds([south_deg, west], [north_deg, east]);
}

export class Boxes {
  constructor(map) {
    Object.assign(this, {map, known: new Map(), group: L.layerGroup().addTo(map)});
    map.createPane('boxes').style.zIndex = 390;
    this.renderer = L.canvas({pane: 'boxes', padding: 0.3});
    map.on('moveend', () => this.draw());
    onColours(() => this.draw());
  }

  add(of, document) {
    if (this.known.has(keyOf(of))) return;
    this.known.set(keyOf(of), {of, document});
    this.draw();
  }

  keepOnly(builds) {
    for (const [key, {of}] of this.known) if (builds.get(of.map) !== of.build) this.known.delete(key);
    this.draw();
  }

  // [{of, document, bounds}] of the maps whose boxes meet the view, or are not known.
  mayBeInView() {
    const view = this.map.getBounds(), {lng} = this.map.getCenter();
    return [...this.known.values()].map((each) => ({...each, bounds: boundsOf(each.document, lng)}))
      .filter(({bounds}) => !bounds || view.intersects(bounds));
  }

  inView() {
    return this.mayBeInView().filter(({bounds}) => bounds);
  }

  sizePx(bounds) {
    const [a, b] = [bounds.getSouthWest(), bounds.getNorthEast()].map((corner) => this.map.latLngToContainerPoint(corner));
    return Math.max(Math.abs(a.x - b.x), Math.abs(a.y - b.y));
  }

  draw() {
    this.group.clearLayers();
    if (this.map.getZoom() >= NEAR_ZOOM) return;
    const named = [];  // places on the screen
    for (const {of, bounds} of this.inView()) {
      const options = {renderer: this.renderer, color: colour('m0'), weight: 1.5, fillColor: colour('m0'), interactive: false};
      const isSmall = this.sizePx(bounds) < SMALL_PX;
      (isSmall ? L.circleMarker(bounds.getCenter(), {...options, radius: CIRCLE_PX, fillOpacity: 0.12})
        : L.rectangle(bounds, {...options, fillOpacity: 0.06})).addTo(this.group);
      this.drawName(of.map, isSmall ? bounds.getCenter() : bounds.getNorthWest(), isSmall, named);
    }
  }

  // Leaves a name out where another one stands.
  drawName(name, at, isBeside, named) {
    const {x, y} = this.map.latLngToContainerPoint(at);
    if (named.some((other) => Math.abs(other.x - x) < NAME_PX.width && Math.abs(other.y - y) < NAME_PX.height)) return;
    named.push({x, y});
    const icon = L.divIcon({className: `map-label${isBeside ? ' beside' : ''}`, iconSize: null, html: h('span', {}, name)});
    L.marker(at, {icon, interactive: false, keyboard: false}).addTo(this.group);
  }

  // The smallest map at a place; null without one.
  at(latLng) {
    const place = this.map.latLngToContainerPoint(latLng);
    const here = this.inView().filter(({bounds}) => {
      const isDot = this.sizePx(bounds) < SMALL_PX;
      return isDot ? this.map.latLngToContainerPoint(bounds.getCenter()).distanceTo(place) < CIRCLE_PX + 2 : bounds.contains(latLng);
    });
    return here.sort((a, b) => this.sizePx(a.bounds) - this.sizePx(b.bounds))[0]?.of ?? null;
  }
}
