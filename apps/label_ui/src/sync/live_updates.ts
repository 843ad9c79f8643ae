// Updates the page when any user changes data on the server. Reports if the server now has another
// map.
import type { ServerEvents } from './events';
import { byId, hint, status } from '../panels/messages';
import type { PeopleWork } from '../people/people_work';
import { fetchJson, type ChangeQueue } from './server';
import type { Store } from '../store';
import type { ClassList, Label, MapName, PaintReport } from '../types';
import type { Work } from '../work';

const kReloadMs = 100; // many labels may change at the same time

export class LiveUpdates {
  private reloadTimer: number | undefined;
  private readonly withoutPaint = new Set<number>();

  constructor(
    private readonly store: Store,
    private readonly work: Work,
    private readonly queue: ChangeQueue,
    private readonly people: PeopleWork,
  ) {}

  begin(events: ServerEvents): void {
    const read = <T>(take: (data: T) => void) => (data: string): void => take(JSON.parse(data) as T);
    events.on('away', (why) => status(why, true));
    events.on('map', read<MapName>((map) => this.serverFound(map)));
    events.on('label', read<Label>((label) => this.label(label)));
    events.on('classes', read<ClassList>((list) => this.classes(list)));
    events.on('paint', read<{ state: string; error: string }>(({ state, error }) => {
      if (state === 'failed') hint(`Search for labels in other images failed: ${error}`, true);
      void this.loadPaint();
    }));
    events.on('people', read<{ state: string; error: string }>(({ state, error }) => void this.people.learned(state, error)));
    events.on('learning', read<{ state: string; error?: string }>(({ state, error }) => this.learning(state, error)));
    this.queue.onOtherMap = () => this.showOtherMap('The server has another map now, or this map was rebuilt.');
    byId('other-map-load').addEventListener('click', () => location.reload());
    byId('other-map').addEventListener('cancel', (event) => event.preventDefault());
    events.begin();
  }

  // The server is available for the first time or again. The page loads the changes since the
  // interruption.
  private serverFound({ name, map, picture }: MapName): void {
    const { start } = this.store;
    if (map !== start.map)
      return this.showOtherMap(name === start.name ? `${name} was rebuilt.` : `The server has another map now: ${name}.`);
    if (picture !== (start.picture?.version ?? '')) return this.showOtherMap('The map has another overhead image now.');
    if (this.queue.count === 0) status('All changes saved');
    void this.load();
  }

  /** The page sends no more changes, because the server has a map for which they were not made. */
  private showOtherMap(what: string): void {
    this.work.flush(); // keeps the changes made with keys together with the others
    this.queue.stop();
    const { count } = this.queue;
    const kept = count > 0 ? ` ${count > 1 ? `${count} changes are` : '1 change is'} not saved yet and kept in this browser.` : '';
    byId('other-map-text').textContent = `${what} This page shows the old state.${kept}`;
    const dialog = byId<HTMLDialogElement>('other-map');
    if (!dialog.open) dialog.showModal();
  }

  private async load(): Promise<void> {
    const { store, work } = this;
    try {
      const before = new Map(store.labels);
      store.receiveLabels((await fetchJson<{ labels: Label[] }>('GET', 'api/labels')).labels, before);
      await Promise.all([work.loadHypotheses(), work.loadProgress(), this.people.refresh(), this.loadPaint()]);
    } catch (fault) {
      status((fault as Error).message, true);
    }
  }

  private async loadPaint(): Promise<void> {
    try {
      const report = await fetchJson<PaintReport>('GET', 'api/paint');
      for (const { id } of report.gone) this.withoutPaint.add(id);
      this.store.receivePaint(report);
    } catch {
      // The status line already reports that the server is not available.
    }
  }

  private label(label: Label): void {
    const { store, work } = this;
    // After an undo, the label may need a check again.
    if (this.withoutPaint.has(label.id)) void this.loadPaint();
    if (!store.receiveLabel(label) || label.request?.startsWith(this.queue.names)) return;
    if (label.who !== store.who) hint(`${label.who} ${label.deleted ? 'deleted' : 'changed'} label ${label.id}`);
    work.changedElsewhere();
    this.reloadTimer ??= window.setTimeout(() => {
      this.reloadTimer = undefined;
      void work.loadHypotheses();
    }, kReloadMs);
  }

  private classes(list: ClassList): void {
    const { store } = this;
    if (list.version > store.classesFrom.version && list.who !== store.who) hint(`${list.who} changed the classes`);
    store.receiveClasses(list);
  }

  private learning(state: string, error = 'failed'): void {
    if (state !== 'running') return void this.work.questions.learned(state === 'failed' ? error : '');
    this.store.progress = { ...this.store.progress, running: true };
    this.store.notify('progress');
  }
}
