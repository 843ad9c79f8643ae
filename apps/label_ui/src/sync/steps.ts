// Undo and redo. The page itself undoes skips and moves of questions. The server undoes all other
// steps.
import { boxFields, middleOf } from '../ground/geometry';
import type { GroundMap } from '../ground/ground_map';
import type { Change } from './kept_changes';
import type { ChangeQueue, Outcome } from './server';
import type { Store } from '../store';
import { isOnGround, type Box, type Fields, type Hypothesis, type Label, type Point } from '../types';
import type { Notifier, Work } from '../work';

/**
 * `request` is the name under which `who` sent the step. `isPending`: the server has not answered
 * yet. `hadNoEffect`: the server stored nothing. `isBlocked`: a later change of another user blocks
 * its undo.
 */
type Sent = { type: 'sent'; request: string; who: string; isPending: boolean; hadNoEffect?: boolean; isBlocked?: boolean };

/** A step that only the page knows. */
export interface PageStep {
  type: 'own';
  name: string;
  /** Whether the step is still valid. The questions change with each round. */
  isValid(): boolean;
  /** `selectionCount`: Store.selectionCount when the user pressed the key. */
  undo(selectionCount: number): void | Promise<void>;
  redo(selectionCount: number): void | Promise<void>;
}
type Step = Sent | PageStep;

/**
 * An undo or redo step that was sent. It moves from one list to the other. `step` is the step that
 * it reverses, if this page knows it.
 */
interface StepBack {
  path: string;
  step?: Sent;
  reversal: Sent;
  from: Step[];
  to: Step[];
  skips: boolean;
}

function removeStep(steps: Step[], step: Step): void {
  if (steps.includes(step)) steps.splice(steps.indexOf(step), 1);
}

export class Steps {
  private done: Step[] = [];
  private undone: Step[] = [];
  private running: Promise<void> = Promise.resolve();
  /** The order of the steps. */
  private readonly order = new WeakMap<Step, number>();
  private count = 0;
  /**
   * The path of the next step that may undo a change of another page, because the user was warned.
   * Empty if there is none.
   */
  private confirmedPath = '';
  /**
   * The changes of other users, as reported by the server. Undo skips the steps that these changes
   * block.
   */
  private skippedConflicts: { id: number; version: number }[] = [];

  constructor(
    private readonly store: Store,
    private readonly queue: ChangeQueue,
    private readonly map: GroundMap,
    private readonly notifier: Notifier,
    private readonly work: Work,
  ) {}

  /** Sends a change. It counts as a step at once, and its undo may wait behind it. */
  async send(method: Change['method'], path: string, body: Record<string, unknown>, shape?: Fields): Promise<Outcome> {
    const step = this.newStep();
    this.addStep(step);
    const outcome = await this.queue.send(method, path, { ...body, who: step.who }, step.request, shape);
    this.recordResult(outcome.status === 'stored', step, this.done);
    return outcome;
  }

  addStep(step: Step): void {
    this.append(this.done, step);
    this.undone = [];
    this.confirmedPath = '';
    this.clearBlocked();
  }

  addSkip({ round, index }: Hypothesis): void {
    const skip = (on: boolean): void => {
      if (on) this.store.skipped.add(index);
      else this.store.skipped.delete(index);
      this.store.notify('hypotheses');
    };
    skip(true);
    this.addStep({
      type: 'own',
      name: 'Skip',
      isValid: () => round === this.store.round,
      undo: (selectionCount) => {
        skip(false);
        this.showHypothesis(index, selectionCount);
      },
      redo: (selectionCount) => {
        skip(true);
        if (selectionCount === this.store.selectionCount) this.work.nextQuestion();
      },
    });
  }

  /** `put` shows the hypothesis in another shape. */
  addMove(index: number, before: Box, now: Box, put: (index: number, box: Box) => void): void {
    const to = (box: Box) => (selectionCount: number): void => {
      put(index, boxFields(box));
      this.showHypothesis(index, selectionCount);
    };
    const { round } = this.store;
    const isValid = (): boolean => round === this.store.round || this.store.hypotheses.has(index);
    this.addStep({ type: 'own', name: 'Move', isValid, undo: to(before), redo: to(now) });
  }

  undo(): Promise<void> {
    return this.step('api/undo');
  }

  redo(): Promise<void> {
    return this.step('api/redo');
  }

  private step(path: 'api/undo' | 'api/redo'): Promise<void> {
    this.work.flush(); // the last change made with keys is the last step
    const undoes = path === 'api/undo';
    const [from, to] = undoes ? [this.done, this.undone] : [this.undone, this.done];
    const last = this.last(from);
    if (last?.type !== 'own') return this.sendStepBack(path, last, from, to);
    this.append(to, last);
    const { selectionCount } = this.store;
    return this.showInOrder(async () => {
      await (undoes ? last.undo(selectionCount) : last.redo(selectionCount));
      this.notifier.status(`${last.name} ${undoes ? 'undone' : 'redone'}`);
    });
  }

  /** Another page has made a change. The page warns the user before it undoes such a change. */
  changedElsewhere(): void {
    this.confirmedPath = '';
  }

  private newStep(): Sent {
    return { type: 'sent', request: this.queue.newName(), who: this.store.who, isPending: true };
  }

  // Runs one display after another, so that the result of an earlier step does not replace that of
  // a later one.
  private showInOrder(show: () => Promise<void>): Promise<void> {
    this.running = this.running.then(show, show);
    return this.running;
  }

  // Returns the last step that is not blocked.
  private last(steps: Step[]): Step | undefined {
    for (const step of [...steps].reverse()) {
      if (step.type === 'sent' && step.isBlocked) continue;
      removeStep(steps, step);
      if (step.type === 'sent' || step.isValid()) return step;
    }
    return undefined;
  }

  private append(steps: Step[], step: Step): void {
    this.order.set(step, ++this.count);
    steps.push(step);
  }

  private reinsert(steps: Step[], step: Step): void {
    if (step.type === 'sent' && step.hadNoEffect) return;
    const at = this.order.get(step)!;
    const later = steps.findIndex((other) => this.order.get(other)! > at);
    steps.splice(later < 0 ? steps.length : later, 0, step);
  }

  private clearBlocked(): void {
    this.skippedConflicts = [];
    for (const step of [...this.done, ...this.undone]) if (step.type === 'sent') step.isBlocked = false;
  }

  // Reverses the last step of this user. `step` is that step if this page knows it. Otherwise it is
  // a step of this page before the reload. The step moves to the other list at once, and back if
  // there is no result.
  private sendStepBack(path: string, step: Sent | undefined, from: Step[], to: Step[]): Promise<void> {
    const reversal = this.newStep();
    const { selectionCount } = this.store;
    const word = path.endsWith('undo') ? 'undone' : 'redone';
    this.append(to, reversal);
    const { skippedConflicts: passed } = this;
    // If this page's blocked steps are skipped, the server searches earlier steps of this page.
    let last = this.confirmedPath === path ? '' : this.queue.names;
    if (step?.who === reversal.who && (step.isPending || passed.length === 0)) last = step.request;
    const stepBack = { path, step, reversal, from, to, skips: passed.length > 0 };
    const sent = this.queue.send('POST', path, { who: reversal.who, last, passed }, reversal.request).then((outcome) => {
      this.updateLists(stepBack, outcome); // at once, because the next key press depends on it
      return outcome;
    });
    return this.showInOrder(async () => this.report(word, await sent, selectionCount));
  }

  private recordResult(stored: boolean, step: Sent, list: Step[]): void {
    step.isPending = false;
    step.hadNoEffect = !stored;
    if (!stored) removeStep(list, step);
  }

  private updateLists({ path, step, reversal, from, to, skips }: StepBack, outcome: Outcome): void {
    const changed = outcome.status === 'stored' && (outcome.labels.length > 0 || outcome.classes !== undefined);
    this.recordResult(changed, reversal, to);
    if (changed && outcome.took !== step?.request) {
      if (step && skips) {
        step.isBlocked = true; // it lies under a blocked step
        this.reinsert(from, step);
      }
      for (const reverted of from.filter((s) => s.type === 'sent' && s.request === outcome.took)) removeStep(from, reverted);
    }
    if (outcome.status === 'conflict') {
      const { id, version } = outcome.about === 'label' ? outcome.current : { id: 0, version: outcome.current.version };
      this.skippedConflicts = [...this.skippedConflicts, { id, version }];
      if (step) step.isBlocked = true;
    }
    if (step && (outcome.status === 'conflict' || (outcome.status === 'cancelled' && this.confirmedPath !== path))) this.reinsert(from, step);
    if (outcome.status === 'otherPage') [from.length, this.confirmedPath] = [0, path];
  }

  private async report(word: string, outcome: Outcome, selectionCount: number): Promise<void> {
    if (outcome.status === 'cancelled') return; // the page has already reported the earlier step
    if (outcome.status === 'conflict') {
      if (outcome.about === 'label') this.store.receiveLabel(outcome.current);
      const why = outcome.about === 'label' ? `${outcome.current.who} has changed label ${outcome.current.id} since` : 'the classes are in use or were changed since';
      return this.notifier.warn(`Not ${word}: ${why}. Press the key again to skip this step`);
    }
    if (outcome.status === 'otherPage')
      return this.notifier.warn(`Not ${word}: ${outcome.message}. Press the key again to continue`);
    const labels = this.work.applyOutcome(outcome);
    if (outcome.status === 'stored') await this.show(word, labels, outcome.classes !== undefined, selectionCount);
  }

  private async show(word: string, labels: Label[], classes: boolean, selectionCount: number): Promise<void> {
    await Promise.all([this.work.loadHypotheses(), this.work.loadProgress()]);
    const last = labels[labels.length - 1];
    if (classes) return this.notifier.status(`Classes: change ${word}`);
    if (!last) this.notifier.status(`Nothing to ${word === 'undone' ? 'undo' : 'redo'}`);
    else this.notifier.status(`${labels.length > 1 ? `${labels.length} labels` : `Label ${last.id}`}: change ${word}`);
    if (last && !isOnGround(last)) return this.notifier.showWindows(labels);
    if (!last || selectionCount !== this.store.selectionCount) return; // the user has selected something else since
    if (!last.deleted) {
      this.work.questions.selectResult({ type: 'label', id: last.id }, selectionCount);
      this.map.showSelected(false);
    } else {
      const again = this.hypothesisAt(middleOf(last.corners));
      if (again) this.showHypothesis(again.index, selectionCount);
      else this.store.selectUnlessChanged(selectionCount, { type: 'none' });
      this.map.showPlace(last.corners);
    }
  }

  private hypothesisAt([x, y]: Point): Hypothesis | undefined {
    return [...this.store.hypotheses.values()].find((h) => Math.hypot(h.x - x, h.y - y) < 0.3);
  }

  private showHypothesis(index: number, selectionCount: number): void {
    if (!this.store.hypotheses.has(index)) return;
    if (this.store.selectedHypothesis()?.index === index) return this.map.showSelected();
    if (this.work.questions.selectResult({ type: 'hypothesis', index }, selectionCount)) this.map.showSelected();
  }
}
