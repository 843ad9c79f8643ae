// The two lines above the map: the state of storing, and a hint for the next action.
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
