// The two lines over the map: how storing stands, and what to do next.
const kHintMs = 6000;
let hintTimer = 0;

export const byId = <T extends HTMLElement>(id: string): T => document.getElementById(id) as T;

export function status(text: string, waiting = false): void {
  byId('status').textContent = text;
  byId('status').className = waiting ? 'waiting' : '';
}

export function hint(text: string, bad = false): void {
  window.clearTimeout(hintTimer);
  byId('hint').textContent = text;
  byId('hint').className = bad ? 'bad' : '';
  if (bad) hintTimer = window.setTimeout(() => hint(''), kHintMs);
}
