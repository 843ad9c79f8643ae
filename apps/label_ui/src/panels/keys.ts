// One key for each action. The page can be used with the keyboard alone.
import { boxOf, moved, movedCorners, turned, turnedCorners } from '../ground/geometry';
import type { Drawing } from '../ground/drawing';
import type { GroundMap } from '../ground/ground_map';
import type { Store } from '../store';
import type { PeopleWork } from '../people/people_work';
import { peopleKey } from '../people/people_keys';
import type { Rows } from '../ground/rows';
import type { Work } from '../work';
import type { Box, Point } from '../types';

const kSmallStepM = 0.05;
const kLargeStepM = 0.5;
const kSmallTurn = Math.PI / 180;
const kLargeTurn = (10 * Math.PI) / 180;
const kSizeStepM = 0.05;

export const kKeys: [string, string][] = [
  ['d', 'draw. Box: click both ends of a long side, then a point on the opposite side. Polygon: click the corners, then press Enter'],
  ['Space', 'while drawing: add a corner at the centre of the map'],
  ['Backspace', 'while drawing: remove the last corner'],
  ['Esc', 'cancel drawing; clear the selection'],
  ['a  r  s', 'accept, reject or skip the question'],
  ['A', 'accept all likely hypotheses in view'],
  ['N', 'go to the area with the most likely hypotheses'],
  ['n', 'next question'],
  ['t', 'train the detector with all labels'],
  ['arrows', 'move the selection by 5 cm (Shift: 50 cm); without a selection, pan the map'],
  ['z  x  c  v', 'rotate 10° left, 1° left, 1° right, 10° right'],
  ['[  ]  {  }', 'narrower, wider, shorter, longer by 5 cm'],
  ['p', 'add a copy at the same spacing (Shift: several copies)'],
  ['b', 'fill the row between the last two selected boxes'],
  ['Del', 'delete the selection'],
  ['Ctrl z  Ctrl y', 'undo, redo'],
  ['1 … 9', 'select a class'],
  [',  .', 'previous class, next class'],
  ['+  -', 'zoom'],
  ['f', 'centre the selection'],
  ['0', 'zoom to the whole map'],
  ['/', 'search'],
  ['m', 'switch between ground and people'],
  ['?', 'show this list'],
];

export const kPeopleKeys: [string, string][] = [
  ['Enter', 'finish the image: likely hypotheses (long dashes) become people, the rest of the image shows no person'],
  ['a  r  s', 'accept, reject or skip the hypothesis; for a label: person, no person'],
  ['d', 'draw a missed person: click the feet, then the head'],
  ['Space', 'while drawing: add a point at the cross; arrows move the cross by 5 pixels (Shift: 40)'],
  ['n', 'next image, without an answer for this image'],
  [',  .', 'previous, next image of this camera'],
  ['1 … 9', 'another camera at the same time'],
  ['arrows', 'move the selection by 1 pixel (Shift: 10); without a selection, pan'],
  ['[  ]  {  }', 'head down, head up, feet up, feet down'],
  ['Tab', 'go to the list of people in the image'],
  ['Del', 'delete the selection'],
  ['t', 'train the person detector'],
  ['+  -  0', 'zoom; show the whole image'],
  ['Ctrl z  Ctrl y', 'undo, redo'],
  ['m', 'switch to the ground'],
];

// Keys that answer a question or add a label need a separate press each time. A held key would
// answer questions that the user has not seen.
const kOnePress = new Set([...'aArsnNbpPdtm ', 'Enter', 'Delete', 'Backspace']);

interface Parts {
  store: Store;
  work: Work;
  rows: Rows;
  map: GroundMap;
  drawing: Drawing;
  people: PeopleWork;
  toggleMode(): void;
  toggleDrawing(): void;
  askCount(): void;
}

export function listenToKeys(parts: Parts): void {
  window.addEventListener('keydown', (event) => {
    const target = event.target as HTMLElement;
    if (document.querySelector('dialog[open]')) return;
    const typing = target.matches('input:not([type=checkbox]):not([type=radio]), select, textarea');
    if (typing && event.key === 'Escape') target.blur();
    if (typing) return;
    const pressed = event.key === ' ' || event.key === 'Enter';
    if (pressed && target.matches('button, input')) return;
    if (handle(event, parts)) event.preventDefault();
  });
}

function handle(event: KeyboardEvent, parts: Parts): boolean {
  const { work, drawing, store, map } = parts;
  if (event.ctrlKey || event.metaKey) {
    const key = event.key.toLowerCase();
    if (key === 'z') void (event.shiftKey ? work.redo() : work.undo());
    else if (key === 'y') void work.redo();
    else return false;
    return true;
  }
  if (event.altKey) return false;
  if (event.repeat && kOnePress.has(event.key)) return true;
  if (event.key === 'm') {
    parts.toggleMode();
    return true;
  }
  if (event.key === '?') {
    (document.getElementById('keys') as HTMLDialogElement).showModal();
    return true;
  }
  if (parts.people.active) return peopleKey(event, parts.people);
  if (drawing.active && drawKey(event.key, drawing, map)) {
    if (event.key === 'Escape') work.questions.showWaiting();
    return true;
  }
  if (shapeKey(event, parts)) return true;
  return classKey(event.key, store) || actionKey(event.key, parts);
}

// There may be more classes than digit keys.
function classKey(key: string, store: Store): boolean {
  const { classes } = store;
  const now = classes.findIndex(({ kind }) => kind === store.kind);
  const step = key === ',' ? -1 : 1;
  const stepped = key === ',' || key === '.' ? classes[(now + step + classes.length) % classes.length] : undefined;
  const chosen = stepped ?? classes[Number(key) - 1];
  if (!chosen) return false;
  store.kind = chosen.kind;
  store.notify('class');
  return true;
}

function drawKey(key: string, drawing: Drawing, map: GroundMap): boolean {
  if (key === ' ') drawing.add(map.centre());
  else if (key === 'Enter' && drawing.begun) drawing.finishPolygon();
  else if (key === 'Backspace' && drawing.begun) drawing.removeLastCorner();
  else if (key === 'Escape' && drawing.begun) drawing.clear();
  else return false;
  return true;
}

function actionKey(key: string, parts: Parts): boolean {
  const { work, store, map } = parts;
  const actions: Record<string, () => void> = {
    a: () => work.answer(true),
    A: () => void work.likely.acceptInView(),
    r: () => work.answer(false),
    s: () => work.skip(),
    n: () => work.nextQuestion(),
    N: () => work.likely.showRest(),
    '0': () => map.showAll(),
    t: () => void work.learn(),
    d: () => parts.toggleDrawing(),
    p: () => void parts.rows.repeat(1),
    b: () => void parts.rows.fill(),
    P: () => parts.askCount(),
    f: () => {
      work.questions.setUserEditing();
      map.showSelected();
    },
    '+': () => map.zoomBy(0.5),
    '=': () => map.zoomBy(0.5),
    '-': () => map.zoomBy(-0.5),
    '/': () => document.getElementById('search')!.focus(),
    Delete: () => void work.removeSelected(),
    Backspace: () => void work.removeSelected(),
    Escape: () => {
      work.flush();
      if (store.selection.type !== 'none') work.deselect();
      else if (parts.drawing.active) parts.toggleDrawing();
      work.questions.showWaiting();
    },
  };
  const action = Object.hasOwn(actions, key) ? actions[key] : undefined;
  action?.();
  return action !== undefined;
}

const kArrows: Record<string, Point> = {
  ArrowLeft: [-1, 0],
  ArrowRight: [1, 0],
  ArrowUp: [0, 1],
  ArrowDown: [0, -1],
};
const kTurns: Record<string, number> = { z: kLargeTurn, x: kSmallTurn, c: -kSmallTurn, v: -kLargeTurn };
const kSizes: Record<string, [number, number]> = {
  '[': [0, -1],
  ']': [0, 1],
  '{': [-1, 0],
  '}': [1, 0],
};

// Handles the keys that move, turn or resize the selected object.
function shapeKey(event: KeyboardEvent, { store, work, map, drawing }: Parts): boolean {
  const key = event.key;
  const arrow = Object.hasOwn(kArrows, key) ? kArrows[key] : null;
  const label = store.selectedLabel();
  const box: Box | null = store.selectedHypothesis() ?? (label && boxOf(label));
  if (arrow && (drawing.begun || (!box && !label))) {
    map.pan(arrow[0], arrow[1]);
    return true;
  }
  if (!box && !label) return false;
  const step = event.shiftKey ? kLargeStepM : kSmallStepM;
  if (arrow) {
    const [dx, dy] = [arrow[0] * step, arrow[1] * step];
    work.reshape(box ? moved(box, dx, dy) : movedCorners(label!.corners, dx, dy));
  } else if (Object.hasOwn(kTurns, key)) {
    work.reshape(box ? turned(box, kTurns[key]) : turnedCorners(label!.corners, kTurns[key]));
  } else if (Object.hasOwn(kSizes, key) && box) {
    const [length, width] = kSizes[key];
    work.reshape({
      ...box,
      length: Math.max(0.1, box.length + length * kSizeStepM),
      width: Math.max(0.1, box.width + width * kSizeStepM),
    });
  } else {
    return false;
  }
  return true;
}
