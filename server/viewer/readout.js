// What the pointer is at: a stretch of a segment, or a position.

import {h, position} from './dom.js';
import {wrappedLongitude} from './lines.js';

// `at(latLng)` finds a segment (Network.at); `tell(hit)` is its text.
export function followPointer(map, node, at, tell) {
  let pointed = null;
  const show = () => {
    const hit = at(pointed);
    node.replaceChildren(...(hit ? [h('strong', {}, hit.segment.segment), ` ${tell(hit)}`] : [position(pointed.lat, wrappedLongitude(pointed.lng))]));
    node.hidden = false;
    map.getContainer().classList.toggle('over-road', Boolean(hit));
    pointed = null;
  };
  map.on('mousemove', ({latlng}) => {
    if (pointed === null) requestAnimationFrame(show);
    pointed = latlng;
  });
  map.on('mouseout', () => { node.hidden = true; });
}
