// The actions of the user. The page sends and shows each action at once. The user can undo each
// action.
import { answerOf, cornersOf } from './ground/geometry';
import { LikelyHypotheses } from './ground/likely_hypotheses';
import { Questions } from './ground/questions';
import { Shaping } from './ground/shaping';
import { fetchJson, type ChangeQueue, type ClassConflict, type LabelConflict, type Outcome } from './sync/server';
import { Steps, type PageStep } from './sync/steps';
import { unanswered } from './open_hypotheses';
import type { GroundMap } from './ground/ground_map';
import type { Store } from './store';
import {
  needsCheck, type Box, type Draft, type Fields, type HypothesisList,
  type Label, type LabelClass, type Point, type ProgressReport, type Standing, type WindowDraft,
} from './types';

export interface Notifier {
  status(message: string): void;
  warn(message: string): void;
  askAboutConflict(met: LabelConflict | ClassConflict): void;
  /** Called after the undo or redo of a step about windows of an image. */
  showWindows(labels: Label[]): void;
}

export class Work {
  readonly questions: Questions;
  readonly likely: LikelyHypotheses;
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
  private listShown = 0;

  constructor(
    private readonly store: Store,
    private readonly queue: ChangeQueue,
    private readonly map: GroundMap,
    private readonly notifier: Notifier,
  ) {
    this.shaping = new Shaping(
      store,
      (label, fields, from) => this.change(label, fields, from),
      (index, before, now, put) => this.steps.addMove(index, before, now, put),
    );
    this.likely = new LikelyHypotheses(store, map, notifier, this);
    this.questions = new Questions(store, map, notifier, this);
    this.steps = new Steps(store, queue, map, notifier, this);
  }

  async create(draft: Draft): Promise<Label | null> {
    this.flush();
    const [label] = this.applyOutcome(await this.steps.send('POST', 'api/labels', { ...draft }));
    if (!label) return null;
    this.notifier.status(`${this.store.classOf(label.kind).title} ${label.id} saved`);
    return label;
  }

  /**
   * Selects the drawn label when it is stored, unless the user has selected something else in the
   * meantime.
   */
  draw(draft: Draft): Promise<void> {
    const { selectionCount, trail } = this.store;
    const place = trail.add(null);
    const drawn = async (): Promise<void> => {
      const label = await this.create(draft);
      if (!label) return trail.remove(place);
      place.id = label.id;
      this.store.selectUnlessChanged(selectionCount, { type: 'label', id: label.id });
      void this.loadHypotheses();
    };
    return this.track(drawn());
  }

  /** Creates several labels as one step: all or none. */
  async createAll(drafts: (Draft | WindowDraft)[]): Promise<Label[]> {
    this.flush();
    return this.applyOutcome(await this.steps.send('POST', 'api/labels', { labels: drafts }));
  }

  /** Changes only the given fields. Earlier waiting changes to the other fields stay. */
  async change(label: Label, fields: Fields, from: Standing = label): Promise<Label | null> {
    const { version, when } = from;
    const body = { ...fields, version, when };
    const [changed] = this.applyOutcome(await this.steps.send('PUT', `api/labels/${label.id}`, body, { ...label, ...fields }));
    if (!changed) return null;
    this.notifier.status(`Label ${label.id} saved`);
    return changed;
  }

  async removeSelected(): Promise<void> {
    const label = this.store.selectedLabel();
    if (label) await this.track(this.rows.then(() => this.removeAndDeselect(label)));
  }

  private async removeAndDeselect(label: Label): Promise<void> {
    this.flush();
    const removed = this.remove(label);
    if (this.store.selectedLabel()?.id === label.id) this.deselect();
    if (await removed) await this.loadHypotheses();
  }

  async remove(label: Label): Promise<boolean> {
    const { id, version, when } = label;
    if (this.applyOutcome(await this.steps.send('DELETE', `api/labels/${id}`, { version, when })).length === 0) return false;
    this.notifier.status(`Label ${id} deleted`);
    return true;
  }

  undo(): Promise<void> {
    return this.track(this.rows.then(() => this.steps.undo()));
  }

  redo(): Promise<void> {
    return this.track(this.rows.then(() => this.steps.redo()));
  }

  /** Adds a step that only the page knows. */
  addStep(step: PageStep): void {
    this.steps.addStep(step);
  }

  /** Another page has changed something. */
  changedElsewhere(): void {
    this.steps.changedElsewhere();
  }

  /**
   * Registers an action that selects something when it ends. A round requested in the meantime
   * starts after it.
   */
  track<T>(action: Promise<T>): Promise<T> {
    this.actions.add(action);
    return action.finally(() => this.actions.delete(action));
  }

  /** Makes a row after all earlier rows are complete, because it starts from their result. */
  row(make: () => Promise<void>): Promise<void> {
    const made = this.track(this.rows.then(make));
    this.rows = made.catch(() => undefined);
    return made;
  }

  /** Deselects the object. */
  deselect(): void {
    this.flush();
    this.questions.deselect();
  }

  /** Replaces the classes of the version `version`. Returns the error, or an empty text. */
  async setClasses(classes: LabelClass[], { version, when }: Standing): Promise<string> {
    const outcome = await this.steps.send('PUT', 'api/classes', { classes, version, when });
    if (outcome.status === 'refused') return outcome.message;
    this.applyOutcome(outcome);
    if (outcome.status === 'stored') this.notifier.status('Classes saved');
    return '';
  }

  reshape(shape: Box | Point[]): void {
    if (this.store.selectedLabel()?.corners.length === 0)
      return this.notifier.warn('This label has no place in the map and cannot be moved');
    this.questions.setUserEditing();
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
    this.questions.setUserEditing();
    await this.track(this.rows.then(() => this.saveFields(label, fields)));
  }

  private saveFields(label: Label, fields: Fields): Promise<unknown> {
    this.flush();
    return this.change(label, fields);
  }

  answer(right: boolean): void {
    const label = this.store.selectedLabel();
    if (label && right && needsCheck(label)) return void this.track(this.confirm(label));
    const h = this.store.selectedHypothesis();
    if (!h) return;
    const wasQuestion = this.questions.isQuestionSelected();
    this.store.removeHypothesis(h.index);
    const stored = this.create(answerOf(h, right)); // first, because a round after the last answer waits for it
    if (wasQuestion) this.nextQuestion();
    else this.questions.deselect(); // a user who looks at another part of the map stays there
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
    const next = this.store.active().find((other) => needsCheck(other) && !this.confirmed.has(other.id));
    if (next) this.store.select({ type: 'label', id: next.id });
    else this.questions.deselect();
    this.map.showSelected();
    await this.change(label, {});
    this.confirmed.delete(label.id);
  }

  skip(): void {
    const h = this.store.selectedHypothesis();
    if (!h) return;
    this.flush();
    if (h.round === this.store.round) this.steps.addSkip(h);
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
      if (turn < this.listShown) return; // a list requested later has already arrived
      this.listShown = turn;
      const since = this.store.active().filter(({ id, version }) => version !== before.get(id)?.version);
      const waiting = this.queue.boxes().map((box) => ({ kind: box.kind, corners: cornersOf(box) }));
      this.store.receiveHypotheses(unanswered(list, [...since, ...waiting]));
    } catch (fault) {
      this.notifier.warn((fault as Error).message);
    }
  }

  async loadProgress(): Promise<void> {
    try {
      this.store.progress = await fetchJson<ProgressReport>('GET', 'api/progress');
      this.store.notify('progress');
    } catch {
      // The status line already reports that the server is not available.
    }
  }

  /**
   * The user has decided the conflict about this request. Until then the browser keeps the change.
   */
  resolveConflict(request: string): void {
    this.queue.resolveConflict(request);
  }

  /** Returns the stored labels. Empty if nothing was stored. */
  applyOutcome(outcome: Outcome): Label[] {
    if (outcome.status === 'stored') {
      for (const label of outcome.labels) this.store.receiveLabel(label);
      if (outcome.classes) this.store.receiveClasses(outcome.classes);
      return outcome.labels;
    }
    if (outcome.status === 'cancelled') return [];
    if (outcome.status === 'conflict') {
      if (outcome.about === 'classes') this.store.receiveClasses(outcome.current);
      else this.store.receiveLabel(outcome.current);
      // An undo or redo step has no second version to choose.
      if (outcome.yours.version !== undefined) this.notifier.askAboutConflict(outcome);
      else this.notifier.warn(`Not undone: ${outcome.current.who} has made a later change`);
    } else {
      this.notifier.warn(outcome.message);
    }
    return [];
  }
}
