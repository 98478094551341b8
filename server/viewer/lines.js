// Geometry of a segment's line: unwrapped longitudes, parts by arc length, distances on the screen.

export const STRETCH_M = 10;  // as in the record of the mapping

const EARTH_RADIUS_M = 6_371_000;
const radians = (degrees) => degrees * Math.PI / 180;

// The longitude that differs from `longitude` by whole turns and is nearest to `reference`.
export const nearLongitude = (longitude, reference) => longitude + 360 * Math.round((reference - longitude) / 360);

export const wrappedLongitude = (longitude) => nearLongitude(longitude, 0);

// Metres between two positions, good enough for what is shown.
export function distance(a, b) {
  const dLat = radians(b.lat - a.lat), dLng = radians(b.lng - a.lng);
  const squared = Math.sin(dLat / 2) ** 2 + Math.cos(radians(a.lat)) * Math.cos(radians(b.lat)) * Math.sin(dLng / 2) ** 2;
  return 2 * EARTH_RADIUS_M * Math.asin(Math.min(1, Math.sqrt(squared)));
}

// Vertices {lat, lng, along_m} of a segment's document; a line across longitude 180 goes on beyond it.
export function lineOf(document) {
  let before = document.line[0][1];
  return document.line.map(([lat, longitude, , along_m]) => {
    before = nearLongitude(longitude, before);
    return {lat, lng: before, along_m};
  });
}

export function pointAt(line, along_m) {
  const after = line.findIndex((vertex) => vertex.along_m >= along_m);
  if (after <= 0) return after === 0 ? line[0] : line[line.length - 1];
  const [from, to] = [line[after - 1], line[after]];
  const share = to.along_m > from.along_m ? (along_m - from.along_m) / (to.along_m - from.along_m) : 0;
  return {lat: from.lat + share * (to.lat - from.lat), lng: from.lng + share * (to.lng - from.lng), along_m};
}

// The part of a line between two arc lengths.
export function partOf(line, from_m, to_m) {
  const inner = line.filter(({along_m}) => along_m > from_m && along_m < to_m);
  return [pointAt(line, from_m), ...inner, pointAt(line, to_m)];
}

// Metres to the right of the line at an arc length, as a position.
export function besides(line, along_m, right_m) {
  const [from, at, to] = [pointAt(line, along_m - 1), pointAt(line, along_m), pointAt(line, along_m + 1)];
  const shrink = Math.cos(radians(at.lat));
  const [east, north] = [(to.lng - from.lng) * shrink, to.lat - from.lat];
  const length = Math.hypot(east, north) || 1;
  const perMetre = 180 / Math.PI / EARTH_RADIUS_M;
  return {lat: at.lat - east / length * right_m * perMetre, lng: at.lng + north / length * right_m * perMetre / shrink};
}

// The nearest point of a polyline of {x, y} to a point: {distance, index of its edge, share of the edge}.
export function nearestOn(points, {x, y}) {
  let best = {distance: Infinity, index: 0, share: 0};
  for (let i = 0; i + 1 < points.length; ++i) {
    const [a, b] = [points[i], points[i + 1]];
    const way = [b.x - a.x, b.y - a.y], squared = way[0] ** 2 + way[1] ** 2;
    const share = squared ? Math.min(Math.max(((x - a.x) * way[0] + (y - a.y) * way[1]) / squared, 0), 1) : 0;
    const far = Math.hypot(a.x + share * way[0] - x, a.y + share * way[1] - y);
    if (far < best.distance) best = {distance: far, index: i, share};
  }
  return best;
}

// {lat, lng} of "49.0102, 8.4011", "49.0102 N 8.4011 E", "49.0102° 8.4011°"; null for anything else.
export function positionIn(text) {
  const match = /^\s*([+\-−]?\d+(?:\.\d+)?)\s*°?\s*([NS]?)\s*[,;\s]\s*([+\-−]?\d+(?:\.\d+)?)\s*°?\s*([EW]?)\s*$/i.exec(text);
  if (!match) return null;
  const signed = (digits, letter, negative) => Number(digits.replace('−', '-')) * (letter.toUpperCase() === negative ? -1 : 1);
  const [lat, lng] = [signed(match[1], match[2], 'S'), signed(match[3], match[4], 'W')];
  return Math.abs(lat) <= 90 && Math.abs(lng) <= 180 ? {lat, lng} : null;
}
