// The builds of maps that this browser has seen, so that a later one can be compared with them.

const KEY = 'milepost.builds';
const MOST_MAPS = 50, MOST_BUILDS = 5;

function stored() {
  try {
    return new Map(JSON.parse(localStorage.getItem(KEY)) ?? []);
  } catch {
    return new Map();  // no storage, or not ours
  }
}

// The builds of a map other than this one, the latest first: [{build, seen}], `seen` an ISO date.
export function olderBuilds({map, build}) {
  return (stored().get(map) ?? []).filter((each) => each.build !== build);
}

export function rememberBuild({map, build}) {
  const all = stored(), seen = new Date().toISOString().slice(0, 10);
  const builds = [{build, seen}, ...(all.get(map) ?? []).filter((each) => each.build !== build)].slice(0, MOST_BUILDS);
  all.delete(map);
  try {
    localStorage.setItem(KEY, JSON.stringify([...all, [map, builds]].slice(-MOST_MAPS)));
  } catch {
    // Without storage nothing is remembered.
  }
}
