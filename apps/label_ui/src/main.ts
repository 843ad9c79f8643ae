// The labelling page: puts the parts together and keeps up with the server.
import Modify from 'ol/interaction/Modify';
import Translate from 'ol/interaction/Translate';
import type Feature from 'ol/Feature';
import type Polygon from 'ol/geom/Polygon';
import { CameraView } from './camera_view';
import { ClassesDialog } from './classes_dialog';
import { ConflictDialog } from './conflict_dialog';
import { Drawing } from './drawing';
import { boxOf, moved, movedCorners } from './geometry';
import { GroundMap } from './ground_map';
import { kKeys, kPeopleKeys, listenToKeys } from './keys';
import { List } from './list';
import { ProgressPanel, SubjectPanel, classButtons } from './panels';
import { ownName } from './own_page';
import { PeoplePanel } from './people_panel';
import { PeoplePicture } from './people_picture';
import { PeopleWork } from './people_work';
import { ChangeQueue, NotAllowed, fetchJson } from './server';
import { Rows } from './rows';
import { Store } from './store';
import type { ClassList, Label, PaintReport, Point, Start } from './types';
import { Work, type Told } from './work';

const byId = <T extends HTMLElement>(id: string): T => document.getElementById(id) as T;
const kDragPx = 2; // a hand that clicks moves by less
const kHintMs = 6000;
const kComeBackMs = 3000;
const kHeardMs = 100; // many labels may be changed together
const kNoPicture = 'this map has no overhead image, so that only people can be labelled: `roadbook overhead` makes one';
let hintTimer = 0;

function status(text: string, waiting = false): void {
  byId('status').textContent = text;
  byId('status').className = waiting ? 'waiting' : '';
}

function hint(text: string, bad = false): void {
  window.clearTimeout(hintTimer);
  byId('hint').textContent = text;
  byId('hint').className = bad ? 'bad' : '';
  if (bad) hintTimer = window.setTimeout(() => hint(''), kHintMs);
}

// Clicks and moves of the pointer: drawing, selecting, dragging what is selected.
function listenToPointer(ground: GroundMap, drawing: Drawing, store: Store, work: Work): void {
  const { map } = ground;
  map.on('pointermove', (event) => {
    if (drawing.active) drawing.move(event.coordinate as Point);
    else byId('map').classList.toggle('over', ground.at(event.pixel) !== null);
  });
  map.on('click', (event) => {
    if (drawing.active) return drawing.add(event.coordinate as Point);
    work.flush();
    const hit = ground.at(event.pixel);
    if (hit) store.select(hit);
    else work.letGo();
  });
  // OpenLayers calls any two quick clicks a double one, wherever they were.
  map.on('dblclick', () => {
    const reach = 8 * map.getView().getResolution()!;
    if (drawing.active && drawing.twiceThere(reach)) drawing.finishPolygon(reach);
  });
  const isPolygon = (): boolean => store.selectedLabel()?.shape === 'polygon';
  const modify = new Modify({ source: ground.marked, condition: () => !drawing.active });
  const translate = new Translate({
    layers: [ground.markedLayer],
    condition: () => !drawing.active,
  });
  const cornersOf = (feature: Feature): Point[] =>
    (feature.getGeometry() as Polygon).getCoordinates()[0].slice(0, -1) as Point[];
  modify.on('modifyend', (event) => work.reshape(cornersOf(event.features.item(0) as Feature)));
  translate.on('translateend', ({ coordinate, startCoordinate }) => {
    const [dx, dy] = [coordinate[0] - startCoordinate[0], coordinate[1] - startCoordinate[1]];
    if (Math.hypot(dx, dy) < kDragPx * map.getView().getResolution()!) return store.tell('selection'); // a click
    const label = store.selectedLabel();
    const box = store.selectedHypothesis() ?? (label && boxOf(label));
    if (box) work.reshape(moved(box, dx, dy));
    else if (label) work.reshape(movedCorners(label.corners, dx, dy));
  });
  map.addInteraction(translate);
  map.addInteraction(modify);
  // Else it marks a corner of every box that the pointer meets.
  const onlyPolygons = (): void => modify.setActive(isPolygon());
  store.on('selection', onlyPolygons);
  onlyPolygons();
}

// A browser comes back by itself where the connection broke, but not where the server has refused it.
async function comeBack(listen: () => void): Promise<void> {
  try {
    await fetchJson('GET', 'api/progress');
    status('too many pages are open: this one waits for its turn', true);
  } catch (fault) {
    status((fault as Error).message, true);
    if (fault instanceof NotAllowed) return;
  }
  window.setTimeout(listen, kComeBackMs);
}

function listenToServer(store: Store, work: Work, queue: ChangeQueue, people: PeopleWork): void {
  const events = new EventSource('api/events');
  let heard: number | undefined;
  const loadPaint = async (): Promise<void> => {
    try {
      store.takePaint(await fetchJson<PaintReport>('GET', 'api/paint'));
    } catch {
      // The status line already says that the server is away.
    }
  };
  const load = async (): Promise<void> => {
    try {
      const before = new Map(store.labels);
      store.takeAll((await fetchJson<{ labels: Label[] }>('GET', 'api/labels')).labels, before);
      await Promise.all([work.loadHypotheses(), work.loadProgress(), people.refresh(), loadPaint()]);
    } catch (fault) {
      status((fault as Error).message, true);
    }
  };
  // Also after a break: what happened meanwhile is fetched.
  events.addEventListener('open', () => {
    status('all stored');
    void load();
  });
  events.addEventListener('error', () => {
    if (events.readyState !== EventSource.CLOSED) return status('the server does not answer', true);
    void comeBack(() => listenToServer(store, work, queue, people));
  });
  events.addEventListener('label', (event) => {
    const label = JSON.parse(event.data as string) as Label;
    if (!store.take(label) || label.request?.startsWith(queue.names)) return;
    if (label.who !== store.who) hint(`${label.who} changed label ${label.id}`);
    work.doneElsewhere();
    heard ??= window.setTimeout(() => {
      heard = undefined;
      void work.loadHypotheses();
    }, kHeardMs);
  });
  events.addEventListener('classes', (event) => {
    const list = JSON.parse(event.data as string) as ClassList;
    if (list.version > store.version && list.who !== store.who) hint(`${list.who} changed the classes`);
    store.takeClasses(list);
  });
  events.addEventListener('paint', () => void loadPaint());
  events.addEventListener('people', (event) => {
    const { state, error } = JSON.parse(event.data as string) as { state: string; error: string };
    void people.learned(state, error);
  });
  events.addEventListener('learning', (event) => {
    const { state, error } = JSON.parse(event.data as string) as { state: string; error?: string };
    if (state === 'running') {
      store.progress = { ...store.progress, running: true };
      store.tell('progress');
    } else {
      void work.questions.learned(state === 'failed' ? (error ?? 'failed') : '');
    }
  });
}

function fillKeys(id: string, keys: [string, string][]): void {
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

function listenToButtons(work: Work, rows: Rows, ground: GroundMap, people: PeopleWork, toggle: () => void, ask: () => void): void {
  const press = (id: string, action: () => void): void => byId(id).addEventListener('click', action);
  press('draw', () => (people.active ? people.toggleDrawing() : toggle()));
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
    ask();
  });
  for (const [name, layer] of Object.entries(ground.layers)) {
    const box = byId<HTMLInputElement>(`layer-${name}`);
    layer.setVisible(box.checked);
    box.addEventListener('change', () => layer.setVisible(box.checked));
  }
}

function whoField(store: Store): void {
  const who = byId<HTMLInputElement>('who');
  who.value = store.who;
  who.addEventListener('change', () => {
    store.who = who.value.trim() || store.start.who;
    who.value = store.who;
    for (const storage of [sessionStorage, localStorage]) storage.setItem('roadbook_who', store.who);
  });
}

async function main(): Promise<void> {
  const start = await fetchJson<Start>('GET', 'api/start');
  document.title = `${start.name}: labels`;
  byId('place').textContent = start.name;
  const store = new Store(start);
  const ground = new GroundMap(byId('map'), store);
  const queue = new ChangeQueue(`roadbook_${start.map}`, await ownName(), (message, count) =>
    status(message ? `${count} not stored yet: ${message}` : 'all stored', message !== ''),
  );
  const conflicts: { dialog?: ConflictDialog } = {};
  const told: Told = {
    say: (message) => status(message),
    warn: (message) => hint(message, true),
    conflict: (current, yours, deletes) => conflicts.dialog?.label(current, yours, deletes),
    classConflict: (current, yours) => conflicts.dialog?.classes(current, yours),
    windows: (labels: Label[]) => {
      setMode(true);
      void people.show(labels[0].anchor);
    },
  };
  const work: Work = new Work(store, queue, ground, told);
  // Before anything else goes out; what has been asked meanwhile is older.
  await queue.resume((outcome) => {
    work.take(outcome);
    void Promise.all([work.loadHypotheses(), work.loadProgress(), people.refresh()]);
  });
  const people: PeopleWork = new PeopleWork(store, work, {
    say: (message) => status(message),
    warn: (message) => hint(message, true),
    hint,
    front: () => people.active || setMode(true),
  });
  const setMode = (on: boolean): void => {
    if (!on && !start.picture) return hint(kNoPicture, true);
    if (drawing.active) toggle();
    document.body.classList.toggle('people', on);
    for (const [id, chosen] of [['mode-ground', !on], ['mode-people', on]] as const)
      byId(id).setAttribute('aria-pressed', String(chosen));
    people.activate(on);
    byId(on ? 'people-picture' : 'map').focus();
  };
  conflicts.dialog = new ConflictDialog(store, work, told);
  const drawing: Drawing = new Drawing(
    store,
    ground,
    (draft) => void work.draw(draft),
    hint,
  );
  work.questions.drawingBegun = () => drawing.begun;
  const toggle = (): void => {
    if (drawing.active) drawing.stop();
    else drawing.start();
    byId('draw').setAttribute('aria-pressed', String(drawing.active));
    byId('map').classList.toggle('drawing', drawing.active);
  };
  const ask = (): void => byId<HTMLDialogElement>('several').showModal();
  classButtons(store);
  new ClassesDialog(store, work);
  new SubjectPanel(store, work);
  new ProgressPanel(store);
  new CameraView(store, byId('view-picture'), byId('view-text'));
  new List(store, byId('rows'), byId('list-count'), () => ground.showSelected(false));
  store.on('class', () => drawing.active && drawing.start());
  fillKeys('keys-table', kKeys);
  fillKeys('people-keys-table', kPeopleKeys);
  whoField(store);
  const rows = new Rows(store, work, ground, told);
  listenToButtons(work, rows, ground, people, toggle, ask);
  new PeoplePanel(store, people);
  new PeoplePicture(byId('people-picture'), store, people);
  byId('mode-ground').addEventListener('click', () => setMode(false));
  byId('mode-people').addEventListener('click', () => setMode(true));
  listenToPointer(ground, drawing, store, work);
  const toggleMode = (): void => setMode(!people.active);
  listenToKeys({ store, work, rows, map: ground, drawing, people, toggleMode, toggleDrawing: toggle, askCount: ask });
  listenToServer(store, work, queue, people);
  window.addEventListener('pagehide', () => work.flush()); // what keys have left is sent by the next
  store.tell('selection');
  if (start.picture) return;
  byId('mode-ground').setAttribute('aria-disabled', 'true');
  byId('mode-ground').title = kNoPicture;
  setMode(true);
}

main().catch((fault: unknown) => status((fault as Error).message, true));
