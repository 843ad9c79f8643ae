// One key for each action on people. The page can be used with the keyboard alone.
import type { PeopleWork } from './people_work';
import type { Point } from '../types';

const kArrows: Record<string, Point> = {
  ArrowLeft: [-1, 0],
  ArrowRight: [1, 0],
  ArrowUp: [0, -1],
  ArrowDown: [0, 1],
};
const kSizes: Record<string, [number, number]> = { '[': [0, 1], ']': [0, -1], '{': [-1, 0], '}': [1, 0] };

/** The position of the cross and the scale of the picture, for use with keys alone. */
export interface Cross {
  at(): Point;
  move(dx: number, dy: number): void;
  zoom(factor: number): void;
  whole(): void;
}
let cross: Cross | null = null;
export function useCross(made: Cross): void {
  cross = made;
}

export function peopleKey(event: KeyboardEvent, people: PeopleWork): boolean {
  const { key } = event;
  const arrow = Object.hasOwn(kArrows, key) ? kArrows[key] : null;
  if (arrow && (people.points || !(people.hypothesis() || people.window()))) {
    const step = event.shiftKey ? 40 : 5;
    cross?.move(arrow[0] * step, arrow[1] * step);
    return true;
  }
  if (arrow) {
    const step = event.shiftKey ? 10 : 1;
    const by: Point = [arrow[0] * step, arrow[1] * step];
    return people.reshape(by, by);
  }
  if (Object.hasOwn(kSizes, key)) {
    const [foot, head] = kSizes[key];
    return people.reshape([0, foot], [0, head]);
  }
  if (people.points && drawKey(key, people)) return true;
  const camera = Number(key);
  if (camera >= 1 && camera <= 9) {
    void people.camera(camera - 1);
    return true;
  }
  return actionKey(key, people);
}

function drawKey(key: string, people: PeopleWork): boolean {
  if (key === ' ') people.point(cross!.at());
  else if (key === 'Backspace' && people.points!.length > 0) people.drawing.removeLastPoint();
  else if (key === 'Escape') people.drawing.toggle();
  else return false;
  return true;
}

function actionKey(key: string, people: PeopleWork): boolean {
  const actions: Record<string, () => void> = {
    a: () => people.answer(true),
    r: () => people.answer(false),
    s: () => people.skip(),
    Enter: () => void people.done(),
    n: () => void people.next(),
    ',': () => void people.neighbour(-1),
    '.': () => void people.neighbour(1),
    d: () => people.drawing.toggle(),
    t: () => void people.learn(),
    '+': () => cross?.zoom(1.4),
    '=': () => cross?.zoom(1.4),
    '-': () => cross?.zoom(1 / 1.4),
    '0': () => cross?.whole(),
    Delete: () => void people.remove(),
    Backspace: () => void people.remove(),
    Escape: () => people.choose({ type: 'none' }),
  };
  const action = Object.hasOwn(actions, key) ? actions[key] : undefined;
  action?.();
  return action !== undefined;
}
