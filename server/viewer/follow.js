// Follows the catalog while the page is visible, and tells when the server is away.

import {onRequests} from './api.js';

const EVERY_MS = 30_000, WHILE_AWAY_MS = 5000;

// `read()` promises that the catalog was read; `back()` is called when a server that was away answers again. Promises
// that the catalog was read, or could not be, for the first time.
export function follow(read, {map, away, back}) {
  let timer = null;
  const ask = async () => {
    clearTimeout(timer);
    if (!document.hidden) await read();
    timer = setTimeout(ask, away.hidden ? EVERY_MS : WHILE_AWAY_MS);
  };
  onRequests((running, isAnswered) => {
    map.setAttribute('aria-busy', String(running > 0));
    if (isAnswered === undefined) return;
    const wasAway = !away.hidden;
    away.hidden = isAnswered;
    away.textContent = isAnswered ? '' : 'The server does not answer. What is shown may be old; the page asks again every five seconds.';
    if (wasAway && isAnswered) back();
  });
  document.addEventListener('visibilitychange', () => { if (!document.hidden) ask(); });
  return ask();
}
