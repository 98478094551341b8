// The line above the map: what happened, until something else is chosen, or what the view needs.

import {count, number} from './dom.js';

const said = {news: '', view: ''};

function say(kind, text) {
  const node = document.getElementById('notice');
  said[kind] = text;
  node.textContent = said.news || said.view;
  node.hidden = !node.textContent;
}

export const tellNews = (text) => say('news', text);
export const forgetNews = () => say('news', '');

// Of the segments that are near, and of those that are drawn.
export function tellView({isTooWide, total, shown}) {
  const isPart = shown < total;
  say('view', isTooWide ? 'Zoom in to see the roads.'
    : isPart ? `Of ${count(total, 'segment')} here the ${number(shown)} nearest to the middle are drawn: zoom in for the rest.` : '');
}
