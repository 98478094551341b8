// The page's state in its address, so that a view can be kept and passed on: #view=17/49.01/8.4&map=town&segment=s1&colour=fit

export function read() {
  const parts = new URLSearchParams(location.hash.slice(1));
  const [zoom, lat, lng] = (parts.get('view') ?? '').split('/').map(Number);
  const isView = [zoom, lat, lng].every(Number.isFinite) && Math.abs(lat) <= 90;
  return {view: isView ? {zoom, lat, lng} : null, map: parts.get('map'), segment: parts.get('segment'), colour: parts.get('colour')};
}

export function write({view: {zoom, lat, lng}, map, segment, colour}) {
  const parts = [`view=${zoom}/${lat.toFixed(7)}/${lng.toFixed(7)}`];
  for (const [name, value] of Object.entries({map, segment, colour})) if (value) parts.push(`${name}=${encodeURIComponent(value)}`);
  history.replaceState(null, '', `#${parts.join('&')}`);
}
