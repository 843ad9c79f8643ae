// What a labeller does: each action is sent at once, shown, and can be taken back.
import { boxFields, cornersOf } from './geometry';
import { overlapShare } from './overlap';
import { Questions } from './questions';
import { Shaping } from './shaping';
import { fetchJson, type ChangeQueue, type Outcome } from './server';
import { Steps } from './steps';
import type { GroundMap } from './ground_map';
import type { Store } from './store';
import {
  needsLook, rejectedKind, type Box, type ClassList, type Draft, type Fields, type Hypothesis, type HypothesisList,
  type Label, type LabelClass, type Point, type ProgressReport, type WindowDraft,
} from './types';

const kMostOverlap = 0.25; // of the smaller of two neighbours, drawn as carelessly as may be

export interface Told {
  say(message: string): void;
  warn(message: string): void;
  conflict(current: Label, yours: Fields & { version: number }, deletes: boolean): void;
  classConflict(current: ClassList, yours: ClassList): void;
  /** A step about windows of an image was taken back or done again. */
  windows(labels: Label[]): void;
}

export class Work {
  readonly questions: Questions;
  /** Sends what keys have left of windows in images. */
  flushWindows = (): void => {};
  private readonly actions = new Set<Promise<unknown>>();
  /** Ends when no row is being made. */
  private rows: Promise<unknown> = Promise.resolve();
  private readonly shaping: Shaping;
  private readonly steps: Steps;

  constructor(
    private readonly store: Store,
    private readonly queue: ChangeQueue,
    private readonly map: GroundMap,
    private readonly told: Told,
  ) {
    this.shaping = new Shaping(store, (label, fields, version) => this.change(label, fields, version));
    this.questions = new Questions(store, map, told, this);
    this.steps = new Steps(store, queue, map, told, this);
  }

  async create(draft: Draft): Promise<Label | null> {
    this.flush();
    const [label] = this.take(await this.steps.send('POST', 'api/labels', { ...draft }));
    if (!label) return null;
    this.told.say(`${this.store.classOf(label.kind).title} ${label.id} stored`);
    return label;
  }

  /** Several as one step: all of them are stored, or none. */
  async createAll(drafts: (Draft | WindowDraft)[]): Promise<Label[]> {
    this.flush();
    return this.take(await this.steps.send('POST', 'api/labels', { labels: drafts }));
  }

  /** Of those fields alone: what others waiting before it make of the rest stays. */
  async change(label: Label, fields: Fields, version = label.version): Promise<Label | null> {
    const [changed] = this.take(await this.steps.send('PUT', `api/labels/${label.id}`, { ...fields, version }));
    if (!changed) return null;
    this.told.say(`label ${label.id} changed`);
    return changed;
  }

  async removeSelected(): Promise<void> {
    const label = this.store.selectedLabel();
    if (label) await this.during(this.rows.then(() => this.removeChosen(label)));
  }

  private async removeChosen(label: Label): Promise<void> {
    this.flush();
    const removed = this.remove(label);
    if (this.store.selectedLabel()?.id === label.id) this.letGo();
    if (await removed) await this.loadHypotheses();
  }

  async remove(label: Label): Promise<boolean> {
    const { id, version } = label;
    if (this.take(await this.steps.send('DELETE', `api/labels/${id}`, { version })).length === 0) return false;
    this.told.say(`label ${id} deleted`);
    return true;
  }

  undo(): Promise<void> {
    return this.during(this.rows.then(() => this.steps.undo()));
  }

  redo(): Promise<void> {
    return this.during(this.rows.then(() => this.steps.redo()));
  }

  /** Another page has changed something. */
  doneElsewhere(): void {
    this.steps.doneElsewhere();
  }

  /** An action that selects something when it ends: learning, asked for meanwhile, comes after it. */
  during<T>(action: Promise<T>): Promise<T> {
    this.actions.add(action);
    return action.finally(() => this.actions.delete(action));
  }

  /** A row begins from what came of all before it: what is pressed meanwhile comes after it. */
  row(make: () => Promise<void>): Promise<void> {
    const made = this.during(this.rows.then(make));
    this.rows = made.catch(() => undefined);
    return made;
  }

  /** Nothing is selected any more. */
  letGo(): void {
    this.flush();
    this.questions.letGo();
  }

  /** Classes that shall replace those of `version`; what is wrong with them, if anything. */
  async setClasses(classes: LabelClass[], version: number): Promise<string> {
    const outcome = await this.steps.send('PUT', 'api/classes', { classes, version });
    if (outcome.status === 'refused') return outcome.message;
    this.take(outcome);
    if (outcome.status === 'stored') this.told.say('classes stored');
    return '';
  }

  reshape(shape: Box | Point[]): void {
    this.questions.atWork();
    this.shaping.reshape(shape);
  }

  flush(): void {
    this.shaping.flush();
    this.flushWindows();
  }

  /** When all that was done is stored. */
  async settle(): Promise<void> {
    this.flush();
    await this.queue.idle();
  }

  /** When all that was begun is done, what it selects selected, and stored. */
  async allDone(): Promise<void> {
    while (this.actions.size > 0) await Promise.allSettled([...this.actions]);
    await this.settle();
  }

  async setFields(fields: Fields): Promise<void> {
    this.questions.atWork();
    const label = this.store.selectedLabel();
    if (label) await this.during(this.rows.then(() => this.setChosen(label, fields)));
  }

  private setChosen(label: Label, fields: Fields): Promise<unknown> {
    this.flush();
    return this.change(label, fields);
  }

  answer(right: boolean): void {
    const label = this.store.selectedLabel();
    if (label && right && needsLook(label)) return void this.during(this.confirm(label));
    const h = this.store.selectedHypothesis();
    if (!h) return;
    const { kind } = h;
    const draft: Draft = {
      ...boxFields(h),
      shape: 'box',
      kind: right ? kind : rejectedKind(kind),
      source: right ? 'accepted' : 'detected',
      score: h.probability,
      note: '',
    };
    const came = this.questions.came();
    this.store.removeHypothesis(h.index);
    const stored = this.create(draft); // first: a round that the last answer begins waits for it
    if (came) this.nextQuestion();
    else this.questions.letGo(); // somebody who looks round stays where he is
    void stored.then((label) => {
      void this.loadProgress();
      if (label) return;
      this.store.skipped.add(h.index);
      void this.loadHypotheses();
    });
  }

  /** A label that has moved with the map is right where it is; on to the next of them. */
  private async confirm(label: Label): Promise<void> {
    this.flush();
    if (!(await this.change(label, {}))) return;
    const next = this.store.active().find(needsLook);
    if (!next) return this.questions.letGo();
    this.store.select({ type: 'label', id: next.id });
    this.map.showSelected();
  }

  /** Accepts what the labeller can see and sees to be right, as one step of undo. */
  acceptInSight(): Promise<void> {
    return this.during(this.acceptThoseInSight());
  }

  private async acceptThoseInSight(): Promise<void> {
    const seen = this.store.likely().filter((h) => this.map.inSight(cornersOf(h)));
    if (seen.length === 0) return this.told.warn('no likely one is wholly in sight');
    const kind = this.store.hypothesisKind;
    const free = this.freeOnes(seen, kind);
    if (free.length === 0) return this.told.warn('those in sight lie on others: put them right, or reject them');
    this.store.select({ type: 'none' });
    const stored = await this.createAll(
      free.map((h) => ({ ...boxFields(h), shape: 'box', kind, source: 'accepted', score: h.probability, note: '' })),
    );
    const left = seen.length - free.length;
    this.told.say(`${stored.length} accepted${left > 0 ? `, ${left} left that lie on others` : ''}`);
    await Promise.all([this.loadHypotheses(), this.loadProgress()]);
    this.questions.bringWaiting();
  }

  // The likeliest first, without those that lie on a thing of their class: two cannot be in one place.
  private freeOnes(list: Hypothesis[], kind: string): Hypothesis[] {
    const taken = this.store.active().filter((label) => label.kind === kind).map((label) => label.corners);
    return [...list].sort((a, b) => b.probability - a.probability).filter((h) => {
      const corners = cornersOf(h);
      const free = taken.every((other) => overlapShare(corners, other) < kMostOverlap);
      if (free) taken.push(corners);
      return free;
    });
  }

  /** On to where most likely ones are left. */
  showRest(): void {
    this.store.select({ type: 'none' });
    const left = this.store.likely();
    if (!this.map.showMost(left.map(cornersOf))) this.told.warn('no likely one is left');
    else this.told.say(`${left.length} likely ones left`);
    this.questions.bringWaiting();
  }

  skip(): void {
    const h = this.store.selectedHypothesis();
    if (!h) return;
    if (h.round === this.store.round) {
      this.store.skipped.add(h.index);
      this.steps.skipped(h);
      this.store.tell('hypotheses');
    }
    this.nextQuestion();
  }

  nextQuestion(): void {
    this.questions.next();
  }

  learn(): Promise<void> {
    return this.questions.learn(this.store.kind);
  }

  async loadHypotheses(): Promise<void> {
    try {
      this.store.takeHypotheses(await fetchJson<HypothesisList>('GET', 'api/hypotheses'));
    } catch (fault) {
      this.told.warn((fault as Error).message);
    }
  }

  async loadProgress(): Promise<void> {
    try {
      this.store.progress = await fetchJson<ProgressReport>('GET', 'api/progress');
      this.store.tell('progress');
    } catch {
      // The status line already says that the server is away.
    }
  }

  /** Labels as they were stored; none where nothing was. */
  take(outcome: Outcome): Label[] {
    if (outcome.status === 'stored') {
      for (const label of outcome.labels) this.store.take(label);
      if (outcome.classes) this.store.takeClasses(outcome.classes);
      return outcome.labels;
    }
    if (outcome.status === 'conflict' && outcome.about === 'classes') {
      this.store.takeClasses(outcome.current);
      this.told.classConflict(outcome.current, outcome.yours);
    } else if (outcome.status === 'conflict') {
      this.store.take(outcome.current);
      this.told.conflict(outcome.current, outcome.yours, outcome.deletes);
    } else {
      this.told.warn(outcome.message);
    }
    return [];
  }
}
