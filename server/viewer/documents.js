// The documents of the catalog's maps. Those of a build never change and are kept.

import {buildPath, getJson, getText, remembered, segmentPath} from './api.js';

export const catalog = () => getJson('/v1/maps').then(({maps}) => maps);

// Keys hold the build, so that a map that was built anew is another one.
const keyOf = (map, build, rest = '') => `${map}/${build}/${rest}`;

const mapDocuments = remembered((key, map) => getJson(`/v1/maps/${map}`), 200);
export const mapDocument = ({map, build}) => mapDocuments(keyOf(map, build), map);

const segmentDocuments = remembered((key, of, signal) => getJson(segmentPath(of), {signal}), 600);
export const segmentDocument = (of, signal) => segmentDocuments(keyOf(of.map, of.build, of.segment), of, signal);

const areas = remembered((key, of) => getJson(`${buildPath(of)}/areas`).then(({cells}) => cells.walls ?? []), 40);
export const wallCells = (of) => areas(keyOf(of.map, of.build), of);

async function loadMapping(of) {
  const manifest = await getJson(`${buildPath(of)}/manifest`);
  if (!manifest.mapping) return null;
  const record = await getJson(`${buildPath(of)}/mapping`);
  return {...record, fits: new Map(record.segments.map(({segment, stretches}) => [segment, stretches]))};
}

// The record of the mapping with `fits`, the stretches by segment; null for a map without one.
const mappings = remembered((key, of) => loadMapping(of), 40);
export const mapping = (of) => mappings(keyOf(of.map, of.build), of);

const landmarkTiles = remembered((key, of, index) =>
  getJson(`/viewer${buildPath(of).slice(3)}/segments/${of.segment}/landmarks/${index}`).then(({landmarks}) => landmarks), 80);
export const landmarks = (of, index) => landmarkTiles(keyOf(of.map, of.build, `${of.segment}/${index}`), of, index);

const wallTiles = remembered((key, of, cell) => getJson(`/viewer${buildPath(of).slice(3)}/walls/${cell}`).then(({walls}) => walls), 120);
export const walls = (of, cell) => wallTiles(keyOf(of.map, of.build, cell), of, cell);

// {map, build, segment, along_m, distance_m, length_m}, nearest first.
export const segmentsNear = ({lat, lng}, radius_m, signal) =>
  getJson(`/v1/segments?near=${lat},${lng}&radius_m=${radius_m}`, {signal}).then(({segments}) => segments);

// What differs between an older build of a map and its current one.
export const changes = ({map}, from) => getJson(`/v1/maps/${map}/changes?from=${encodeURIComponent(from)}`);

// The paths that this server answers, so that nothing is asked of it that it does not have.
export const paths = remembered(() => getText('/openapi.yaml').then((text) => new Set([...text.matchAll(/^ {2}(\/\S*):$/gm)].map(([, path]) => path))), 1);
