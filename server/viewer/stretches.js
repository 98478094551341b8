// What is known of a segment on each ten metres, from its document, the map's and the record of the mapping.

import {STRETCH_M} from './lines.js';

export const LANDMARKS = 'tracklets';  // the layer of the default method

// Items of a layer per metre of [from_m, to_m]: a tile holds what begins in its own length of the segment.
function density(tiles, tileLength_m, length_m, from_m, to_m) {
  let items = 0;
  for (const tile of tiles) {
    const start = tile.index * tileLength_m, end = Math.min(start + tileLength_m, length_m);
    const common = Math.min(end, to_m) - Math.max(start, from_m);
    if (common > 0 && end > start) items += tile.items * common / (end - start);
  }
  return items / (to_m - from_m);
}

// Of the fits of all drives on one stretch: the share of features that fit, and their reprojection error.
function fitOf(fits) {
  const sum = (value) => fits.reduce((total, fit) => total + value(fit), 0);
  const [followed, fitting] = [sum((fit) => fit.followed), sum((fit) => fit.fitting)];
  return {
    fit_percent: followed ? 100 * fitting / followed : null,
    reprojection_px: fitting ? Math.sqrt(sum((fit) => fit.fitting * fit.reprojection_px ** 2) / fitting) : null,
  };
}

// One entry for each ten metres; values that are not known are null. `fits` are the segment's stretches in the record of
// the mapping, empty without one.
export function stretchesOf(document, mapDocument, fits) {
  const length_m = document.length_m, tiles = document.tiles[LANDMARKS];
  const tileLength_m = mapDocument.layer_parameters[LANDMARKS]?.tile_length_m;
  const stretches = [];
  for (let from_m = 0; from_m < length_m; from_m += STRETCH_M) {
    const to_m = Math.min(from_m + STRETCH_M, length_m);
    stretches.push({
      from_m, to_m,
      landmarks_per_m: tiles && tileLength_m ? density(tiles, tileLength_m, length_m, from_m, to_m) : null,
      passes: document.passes.length || null,
      sigma_m: document.position_sigma_m ?? null,
      ...fitOf(fits.filter((fit) => Math.abs(fit.from_m - from_m) < STRETCH_M / 2)),
    });
  }
  return stretches;
}

// The sums of a segment's tile index: {items, bytes, tiles} of one layer or of all.
export function totals(document, layer = null) {
  const tiles = Object.entries(document.tiles).filter(([name]) => layer === null || name === layer).flatMap(([, index]) => index);
  const sum = (key) => tiles.reduce((total, tile) => total + tile[key], 0);
  return {items: sum('items'), bytes: sum('bytes'), tiles: tiles.length};
}
