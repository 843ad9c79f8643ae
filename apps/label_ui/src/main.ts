// The labelling page: creates and connects the parts.
import { fillKeys, listenToButtons, whoField } from './panels/buttons';
import { CameraView } from './panels/camera_view';
import { ClassesDialog } from './panels/classes_dialog';
import { ConflictDialog } from './panels/conflict_dialog';
import { Drawing } from './ground/drawing';
import { ServerEvents } from './sync/events';
import { LiveUpdates } from './sync/live_updates';
import { GroundMap } from './ground/ground_map';
import { kKeys, kPeopleKeys, listenToKeys } from './panels/keys';
import { UnsavedChanges } from './sync/unsaved_changes';
import { List } from './panels/list';
import { byId, hint, status } from './panels/messages';
import { Modes } from './panels/modes';
import { ProgressPanel, SubjectPanel, classButtons } from './panels/panels';
import { ownName } from './sync/own_page';
import { PeoplePanel } from './people/people_panel';
import { PeoplePicture } from './people/people_picture';
import { PeopleWork } from './people/people_work';
import { listenToPointer } from './ground/pointer';
import { ChangeQueue, fetchJson, type Outcome } from './sync/server';
import { Rows } from './ground/rows';
import { Store } from './store';
import type { Label, Start } from './types';
import { Work, type Notifier } from './work';

/** The parts that carry out the user's actions, without the panels that show them. */
interface Parts {
  store: Store;
  ground: GroundMap;
  queue: ChangeQueue;
  work: Work;
  people: PeopleWork;
  drawing: Drawing;
  modes: Modes;
  notifier: Notifier;
}

const warn = (message: string): void => hint(message, true);
const showStatus = (message: string): void => status(message);

function makeParts(start: Start, page: string): Parts {
  const store = new Store(start);
  const ground = new GroundMap(byId('map'), store);
  const queue = new ChangeQueue(start, page, (message, count) =>
    status(message ? `${count} ${count === 1 ? 'change' : 'changes'} not saved yet: ${message}` : 'All changes saved', message !== ''),
  );
  const windows = (labels: Label[]): void => {
    modes.toPeople(true);
    void people.show(labels[0].anchor);
  };
  const notifier: Notifier = { status: showStatus, warn, askAboutConflict: (met) => conflicts.show(met), showWindows: windows };
  const work: Work = new Work(store, queue, ground, notifier);
  const front = (): void => void (people.active || modes.toPeople(true));
  const people: PeopleWork = new PeopleWork(store, work, { status: showStatus, warn, hint, showPeopleMode: front });
  const drawing: Drawing = new Drawing(store, ground, (draft) => void work.draw(draft), hint);
  work.questions.drawingBegun = () => drawing.begun;
  const modes: Modes = new Modes(store, people, drawing);
  const conflicts: ConflictDialog = new ConflictDialog(store, work, notifier);
  return { store, ground, queue, work, people, drawing, modes, notifier };
}

function makePanels({ store, ground, work, people, notifier }: Parts): void {
  classButtons(store);
  new ClassesDialog(store, work);
  new SubjectPanel(store, work);
  new ProgressPanel(store);
  new CameraView(store, byId('view-picture'), byId('view-text'));
  new List(store, byId('rows'), byId('list-count'), () => ground.showSelected(false), notifier);
  new PeoplePanel(store, people);
  new PeoplePicture(byId('people-picture'), store, people);
  fillKeys('keys-table', kKeys);
  fillKeys('people-keys-table', kPeopleKeys);
  whoField(store);
}

function listen({ store, ground, work, people, drawing, modes, notifier }: Parts): void {
  const rows = new Rows(store, work, ground, notifier);
  const toggleDrawing = (): void => modes.toggleDrawing();
  const toggleMode = (): void => modes.toggle();
  const askCount = (): void => byId<HTMLDialogElement>('several').showModal();
  listenToButtons({ work, rows, ground, people, toggleDrawing, askCount });
  listenToPointer(ground, drawing, store, work);
  listenToKeys({ store, work, rows, map: ground, drawing, people, toggleMode, toggleDrawing, askCount });
  window.addEventListener('pagehide', () => work.flush()); // the next page sends the changes made with keys
}

async function main(): Promise<void> {
  const start = await fetchJson<Start>('GET', 'api/start');
  document.title = `${start.name}: labels`;
  byId('place').textContent = start.name;
  const page = await ownName();
  const parts = makeParts(start, page);
  const { store, queue, work, people, modes } = parts;
  const takeLate = (outcome: Outcome): void => {
    work.applyOutcome(outcome);
    void Promise.all([work.loadHypotheses(), work.loadProgress(), people.refresh()]);
  };
  const leftOver = new UnsavedChanges(start, queue, takeLate);
  await queue.resume(takeLate); // before any other request; answers to earlier requests are older
  makePanels(parts);
  listen(parts);
  new LiveUpdates(store, work, queue, people).begin(new ServerEvents());
  void leftOver.find(page);
  store.notify('selection');
  if (!start.picture) modes.toPeople(true);
}

main().catch((fault: unknown) => status((fault as Error).message, true));
