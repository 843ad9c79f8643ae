// The actions of the user. The page sends and shows each action at once. The user can undo each
// action.
import { answerOf, cornersOf } from './ground/geometry';
import { LikelyOnes } from './ground/likely_ones';
import { Questions } from './ground/questions';
import { Shaping } from './ground/shaping';
import { fetchJson, type ChangeQueue, type ClassConflict, type LabelConflict, type Outcome } from './sync/server';
import { Steps, type OwnStep } from './sync/steps';
import { unanswered } from './unanswered';
import type { GroundMap } from './ground/ground_map';
import type { Store } from './store';
import {
  needsLook, type Box, type Draft, type Fields, type HypothesisList,
  type Label, type LabelClass, type Point, type ProgressReport, type Standing, type WindowDraft,
} from './types';

export interface Told {
  say(message: string): void;
  warn(message: string): void;
  conflict(met: LabelConflict | ClassConflict): void;
  /** Called after the undo or redo of a step about windows of an image. */
  windows(labels: Label[]): void;
}

export class Work {
  readonly questions: Questions;
  readonly likely: LikelyOnes;
  /** Sends the changes that keys have made to windows in images. */
  flushWindows = (): void => {};
  private readonly actions = new Set<Promise<unknown>>();
  /** Resolves when no row is being made. */
  private rows: Promise<unknown> = Promise.resolve();
  private readonly shaping: Shaping;
  private readonly steps: Steps;
  /** Labels whose confirmation is not stored yet. */
  private readonly confirmed = new Set<number>();
  /** The number of requested lists of hypotheses, and the number of the displayed list. */
  private listsAsked = 0;
  private listTaken = 0;

  constructor(
    private readonly store: Store,
    private readonly queue: ChangeQueue,
    private readonly map: GroundMap,
    private readonly told: Told,
  ) {
    this.shaping = new Shaping(
      store,
      (label, fields, from) => this.change(label, fields, from),
      (index, before, now, put) => this.steps.nudged(index, before, now, put),
    );
    this.likely = new LikelyOnes(store, map, told, this);
    this.questions = new Questions(store, map, told, this);
    this.steps = new Steps(store, queue, map, told, this);
  }

  async create(draft: Draft): Promise<Label | null> {
    this.flush();
    const [label] = this.take(await this.steps.send('POST', 'api/labels', { ...draft }));
    if (!label) return null;
    this.told.say(`${this.store.classOf(label.kind).title} ${label.id} saved`);
    return label;
  }

  /**
   * Selects the drawn label when it is stored, unless the user has selected something else in the
   * meantime.
   */
  draw(draft: Draft): Promise<void> {
    const { chosen, trail } = this.store;
    const place = trail.put(null);
    const drawn = async (): Promise<void> => {
      const label = await this.create(draft);
      if (!label) return trail.drop(place);
      place.id = label.id;
      this.store.selectAfter(chosen, { type: 'label', id: label.id });
      void this.loadHypotheses();
    };
    return this.during(drawn());
  }

  /** Creates several labels as one step: all or none. */
  async createAll(drafts: (Draft | WindowDraft)[]): Promise<Label[]> {
    this.flush();
    return this.take(await this.steps.send('POST', 'api/labels', { labels: drafts }));
  }

  /** Changes only the given fields. Earlier waiting changes to the other fields stay. */
  async change(label: Label, fields: Fields, from: Standing = label): Promise<Label | null> {
    const { version, when } = from;
    const body = { ...fields, version, when };
    const [changed] = this.take(await this.steps.send('PUT', `api/labels/${label.id}`, body, { ...label, ...fields }));
    if (!changed) return null;
    this.told.say(`Label ${label.id} saved`);
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
    const { id, version, when } = label;
    if (this.take(await this.steps.send('DELETE', `api/labels/${id}`, { version, when })).length === 0) return false;
    this.told.say(`Label ${id} deleted`);
    return true;
  }

  undo(): Promise<void> {
    return this.during(this.rows.then(() => this.steps.undo()));
  }

  redo(): Promise<void> {
    return this.during(this.rows.then(() => this.steps.redo()));
  }

  /** Adds a step that only the page knows. */
  remember(step: OwnStep): void {
    this.steps.remember(step);
  }

  /** Another page has changed something. */
  doneElsewhere(): void {
    this.steps.doneElsewhere();
  }

  /**
   * Registers an action that selects something when it ends. A round requested in the meantime
   * starts after it.
   */
  during<T>(action: Promise<T>): Promise<T> {
    this.actions.add(action);
    return action.finally(() => this.actions.delete(action));
  }

  /** Makes a row after all earlier rows are complete, because it starts from their result. */
  row(make: () => Promise<void>): Promise<void> {
    const made = this.during(this.rows.then(make));
    this.rows = made.catch(() => undefined);
    return made;
  }

  /** Deselects the object. */
  letGo(): void {
    this.flush();
    this.questions.letGo();
  }

  /** Replaces the classes of the version `version`. Returns the error, or an empty text. */
  async setClasses(classes: LabelClass[], { version, when }: Standing): Promise<string> {
    const outcome = await this.steps.send('PUT', 'api/classes', { classes, version, when });
    if (outcome.status === 'refused') return outcome.message;
    this.take(outcome);
    if (outcome.status === 'stored') this.told.say('Classes saved');
    return '';
  }

  reshape(shape: Box | Point[]): void {
    if (this.store.selectedLabel()?.corners.length === 0)
      return this.told.warn('This label has no place in the map and cannot be moved');
    this.questions.atWork();
    this.shaping.reshape(shape);
  }

  flush(): void {
    this.shaping.flush();
    this.flushWindows();
  }

  /** Waits until all changes are stored. */
  async settle(): Promise<void> {
    this.flush();
    await this.queue.idle();
  }

  /** Waits until all started actions are complete, and their results are selected and stored. */
  async allDone(): Promise<void> {
    while (this.actions.size > 0) await Promise.allSettled([...this.actions]);
    await this.settle();
  }

  async setFields(label: Label, fields: Fields): Promise<void> {
    this.questions.atWork();
    await this.during(this.rows.then(() => this.setChosen(label, fields)));
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
    const came = this.questions.came();
    this.store.removeHypothesis(h.index);
    const stored = this.create(answerOf(h, right)); // first, because a round after the last answer waits for it
    if (came) this.nextQuestion();
    else this.questions.letGo(); // a user who looks at another part of the map stays there
    void stored.then((label) => {
      void this.loadProgress();
      if (label) return;
      this.store.skipped.add(h.index);
      void this.loadHypotheses();
    });
  }

  /**
   * Confirms that a label that has moved with the map is correct at its new place. Then selects the
   * next such label.
   */
  private async confirm(label: Label): Promise<void> {
    this.flush();
    this.confirmed.add(label.id);
    const next = this.store.active().find((other) => needsLook(other) && !this.confirmed.has(other.id));
    if (next) this.store.select({ type: 'label', id: next.id });
    else this.questions.letGo();
    this.map.showSelected();
    await this.change(label, {});
    this.confirmed.delete(label.id);
  }

  skip(): void {
    const h = this.store.selectedHypothesis();
    if (!h) return;
    this.flush();
    if (h.round === this.store.round) this.steps.skipped(h);
    this.nextQuestion();
  }

  nextQuestion(): void {
    this.questions.next();
  }

  learn(): Promise<void> {
    return this.questions.learn(this.store.kind);
  }

  async loadHypotheses(): Promise<void> {
    const turn = ++this.listsAsked;
    const before = new Map(this.store.labels);
    try {
      const list = await fetchJson<HypothesisList>('GET', 'api/hypotheses');
      if (turn < this.listTaken) return; // a list requested later has already arrived
      this.listTaken = turn;
      const since = this.store.active().filter(({ id, version }) => version !== before.get(id)?.version);
      const waiting = this.queue.boxes().map((box) => ({ kind: box.kind, corners: cornersOf(box) }));
      this.store.takeHypotheses(unanswered(list, [...since, ...waiting]));
    } catch (fault) {
      this.told.warn((fault as Error).message);
    }
  }

  async loadProgress(): Promise<void> {
    try {
      this.store.progress = await fetchJson<ProgressReport>('GET', 'api/progress');
      this.store.tell('progress');
    } catch {
      // The status line already reports that the server is not available.
    }
  }

  /**
   * The user has decided the conflict about this request. Until then the browser keeps the change.
   */
  decided(request: string): void {
    this.queue.decided(request);
  }

  /** Returns the stored labels. Empty if nothing was stored. */
  take(outcome: Outcome): Label[] {
    if (outcome.status === 'stored') {
      for (const label of outcome.labels) this.store.take(label);
      if (outcome.classes) this.store.takeClasses(outcome.classes);
      return outcome.labels;
    }
    if (outcome.status === 'behind') return [];
    if (outcome.status === 'conflict') {
      if (outcome.about === 'classes') this.store.takeClasses(outcome.current);
      else this.store.take(outcome.current);
      // An undo or redo step has no second version to choose.
      if (outcome.yours.version !== undefined) this.told.conflict(outcome);
      else this.told.warn(`Not undone: ${outcome.current.who} has made a later change`);
    } else {
      this.told.warn(outcome.message);
    }
    return [];
  }
}
