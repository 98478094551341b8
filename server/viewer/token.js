// The token that a server asks for: typed once, kept for this tab alone.

import {h} from './dom.js';

const KEPT_AS = 'milepost-token';
let asking = null;  // a promise, while the form is shown

const kept = () => {
  try {
    return sessionStorage.getItem(KEPT_AS);
  } catch {
    return null;  // the browser keeps nothing
  }
};
let token = kept();

export const authorization = () => (token ? {Authorization: `Bearer ${token}`} : {});

function take(text) {
  token = text;
  try {
    sessionStorage.setItem(KEPT_AS, text);
  } catch {
    // Then it is asked for again when the page is loaded again.
  }
}

// Shows a form that says why, for all that wait. Resolves to false if it is left.
export function askForToken(why) {
  asking ??= shown(why).finally(() => { asking = null; });
  return asking;
}

function shown(why) {
  const input = h('input', {type: 'password', id: 'token', autocomplete: 'off', spellcheck: 'false', required: 'required'});
  const form = h('form', {method: 'dialog'},
    h('h2', {}, 'Token'),
    h('p', {class: 'note'}, why),
    h('label', {for: 'token', class: 'note'}, 'The token that the operator of this server gave you'),
    input,
    h('div', {class: 'compare'},
      h('button', {value: 'use'}, 'Use it'),
      h('button', {value: 'leave', formnovalidate: 'formnovalidate'}, 'Leave')));
  const dialog = h('dialog', {class: 'token'}, form);
  document.body.append(dialog);
  dialog.showModal();
  return new Promise((resolve) => {
    dialog.addEventListener('close', () => {
      const isGiven = dialog.returnValue === 'use' && input.value.trim();
      if (isGiven) take(input.value.trim());
      dialog.remove();
      resolve(Boolean(isGiven));
    });
  });
}
