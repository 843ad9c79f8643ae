// The buttons above the map, the list of keys, and the user's name.
import type { GroundMap } from '../ground/ground_map';
import { byId } from './messages';
import type { PeopleWork } from '../people/people_work';
import type { Rows } from '../ground/rows';
import type { Store } from '../store';
import type { Work } from '../work';

export function fillKeys(id: string, keys: [string, string][]): void {
  const table = document.createElement('table');
  for (const [key, text] of keys) {
    const row = table.insertRow();
    const kbd = document.createElement('kbd');
    kbd.textContent = key;
    row.insertCell().append(kbd);
    row.insertCell().textContent = text;
  }
  byId(id).append(table);
}

interface Parts {
  work: Work;
  rows: Rows;
  ground: GroundMap;
  people: PeopleWork;
  toggleDrawing(): void;
  askCount(): void;
}

export function listenToButtons({ work, rows, ground, people, toggleDrawing, askCount }: Parts): void {
  const press = (id: string, action: () => void): void => byId(id).addEventListener('click', action);
  press('draw', () => (people.active ? people.drawing.toggle() : toggleDrawing()));
  press('repeat', (): void => void rows.repeat(1));
  press('fill', (): void => void rows.fill());
  press('learn', (): void => void (people.active ? people.learn() : work.learn()));
  press('undo', (): void => void work.undo());
  press('redo', (): void => void work.redo());
  press('help', () => byId<HTMLDialogElement>('keys').showModal());
  const several = byId<HTMLDialogElement>('several');
  several.addEventListener('close', () => {
    const count = byId<HTMLInputElement>('several-count').valueAsNumber;
    if (several.returnValue === 'yes' && count >= 1) void rows.repeat(count);
    byId('map').focus();
  });
  byId('repeat').addEventListener('contextmenu', (event) => {
    event.preventDefault();
    askCount();
  });
  for (const [name, layer] of Object.entries(ground.layers)) {
    const box = byId<HTMLInputElement>(`layer-${name}`);
    layer.setVisible(box.checked);
    box.addEventListener('change', () => layer.setVisible(box.checked));
  }
}

export function whoField(store: Store): void {
  const who = byId<HTMLInputElement>('who');
  who.value = store.who;
  who.addEventListener('change', () => {
    store.who = who.value.trim() || store.start.who;
    who.value = store.who;
    for (const storage of [sessionStorage, localStorage]) storage.setItem('roadbook_who', store.who);
  });
}
