// Requests to the server: few at a time, failures told apart.

import {askForToken, authorization} from './token.js';

const MOST_AT_ONCE = 6;
const WAIT_MS = 20_000;  // then the server counts as away

// `status` is 0 if the server did not answer.
class Failure extends Error {
  constructor(status, text) {
    super(text);
    this.status = status;
  }
}

export const isAborted = (failure) => failure.name === 'AbortError';

const waiting = [];
let running = 0;
const listeners = new Set();

// Calls back with the number of requests in progress, and with whether the last one was answered.
export function onRequests(listener) {
  listeners.add(listener);
}

function tell(isAnswered) {
  for (const listener of listeners) listener(running + waiting.length, isAnswered);
}

function startNext() {
  while (running < MOST_AT_ONCE && waiting.length) {
    const task = waiting.shift();
    ++running;
    task().finally(() => {
      --running;
      startNext();
      tell();
    });
  }
}

function queued(task, signal) {
  return new Promise((resolve, reject) => {
    const entry = () => task().then(resolve, reject);
    waiting.push(entry);
    signal?.addEventListener('abort', () => {
      const at = waiting.indexOf(entry);
      if (at < 0) return;
      waiting.splice(at, 1);
      reject(new DOMException('', 'AbortError'));
      tell();
    });
    tell();
    startNext();
  });
}

async function request(path, signal) {
  const timer = AbortSignal.timeout(WAIT_MS);
  const either = signal ? AbortSignal.any([signal, timer]) : timer;
  const sent = authorization().Authorization;
  let response;
  try {
    response = await fetch(path, {signal: either, headers: authorization()});
  } catch (failure) {
    if (signal?.aborted) throw new DOMException('', 'AbortError');
    tell(false);
    throw new Failure(0, 'The server does not answer.');
  }
  tell(true);
  if (response.ok) return response;
  const problem = await response.json().catch(() => ({}));
  // Of all that was asked for without a token, the first one's form is answered for.
  const isAsked = response.status === 401 && !signal?.aborted;
  if (isAsked && (sent !== authorization().Authorization || await askForToken(sent ? problem.detail : 'This server shows its maps to those who have a token.'))) return request(path, signal);
  throw new Failure(response.status, problem.detail || `The server answers with ${response.status}.`);
}

const answer = (path, read, signal) => queued(() => request(path, signal).then(read), signal);

export const getJson = (path, {signal} = {}) => answer(path, (response) => response.json(), signal);
export const getText = (path, {signal} = {}) => answer(path, (response) => response.text(), signal);

// A function of one argument that keeps its latest results; a failure is not kept.
export function remembered(load, most) {
  const kept = new Map();
  return (key, ...more) => {
    if (kept.has(key)) return kept.get(key);
    const result = load(key, ...more);
    kept.set(key, result);
    result.catch(() => kept.delete(key));
    if (kept.size > most) kept.delete(kept.keys().next().value);
    return result;
  };
}

export const buildPath = ({map, build}) => `/v1/maps/${map}/builds/${build}`;
export const segmentPath = (of) => `${buildPath(of)}/segments/${of.segment}`;
