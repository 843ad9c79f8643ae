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
  ['d', 'draw: three clicks for a box (a long side, then the side across); Enter ends a polygon'],
  ['Space', 'when drawing: a corner at the cross in the middle of the map'],
  ['Backspace', 'when drawing: take the last corner back'],
  ['Esc', 'stop drawing, select nothing'],
  ['a  r  s', 'accept, reject, skip the question'],
  ['A', 'accept all likely ones that are wholly in sight'],
  ['N', 'on to where most likely ones are left'],
  ['n', 'next question'],
  ['t', 'learn from all labels'],
  ['arrows', 'move what is selected by 5 cm, with Shift by 50 cm; else move the map'],
  ['z  x  c  v', 'turn: 10° left, 1° left, 1° right, 10° right'],
  ['[  ]  {  }', 'narrower, wider, shorter, longer by 5 cm'],
  ['p', 'repeat: one more at this spacing; Shift+p asks how many'],
  ['b', 'fill the row between the two boxes that were selected last'],
  ['Del', 'delete what is selected'],
  ['Ctrl z  Ctrl y', 'undo, redo'],
  ['1 … 9', 'class'],
  [',  .', 'the class before, after'],
  ['+  -', 'zoom'],
  ['f', 'bring what is selected to the centre'],
  ['0', 'show the whole place'],
  ['/', 'search'],
  ['m', 'between the ground and people in the images'],
  ['?', 'these keys'],
];

export const kPeopleKeys: [string, string][] = [
  ['Enter', 'done: the likely ones (long dashes) are people, all else is nobody; on to the next image'],
  ['a  r  s', 'accept, reject, skip the one that is asked about; of a label: somebody, nobody'],
  ['d', 'draw somebody who was missed: the feet, then the head'],
  ['Space', 'when drawing: a point at the cross, which the arrows move by 5 pixels, with Shift by 40'],
  ['n', 'next image, nothing said about this one'],
  [',  .', 'the same camera a moment earlier, later'],
  ['1 … 9', 'another camera at this moment'],
  ['arrows', 'move what is selected by 1 pixel, with Shift by 10; else the view'],
  ['[  ]  {  }', 'head down, head up, feet up, feet down'],
  ['Tab', 'on to the list of what is in the image'],
  ['Del', 'delete what is selected'],
  ['t', 'learn'],
  ['+  -  0', 'zoom, the whole image'],
  ['Ctrl z  Ctrl y', 'undo, redo'],
  ['m', 'to the ground'],
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
    if (event.key === 'Escape') work.questions.bringWaiting();
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
  store.tell('class');
  return true;
}

function drawKey(key: string, drawing: Drawing, map: GroundMap): boolean {
  if (key === ' ') drawing.add(map.centre());
  else if (key === 'Enter' && drawing.begun) drawing.finishPolygon();
  else if (key === 'Backspace' && drawing.begun) drawing.back();
  else if (key === 'Escape' && drawing.begun) drawing.clear();
  else return false;
  return true;
}

function actionKey(key: string, parts: Parts): boolean {
  const { work, store, map } = parts;
  const actions: Record<string, () => void> = {
    a: () => work.answer(true),
    A: () => void work.likely.acceptInSight(),
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
      work.questions.atWork();
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
      if (store.selection.type !== 'none') work.letGo();
      else if (parts.drawing.active) parts.toggleDrawing();
      work.questions.bringWaiting();
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
