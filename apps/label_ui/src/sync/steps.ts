// Undo and redo. The page itself undoes skips and moves of questions. The server undoes all other
// steps.
import { boxFields, middleOf } from '../ground/geometry';
import type { GroundMap } from '../ground/ground_map';
import type { Change } from './kept_changes';
import type { ChangeQueue, Outcome } from './server';
import type { Store } from '../store';
import { isOnGround, type Box, type Fields, type Hypothesis, type Label, type Point } from '../types';
import type { Told, Work } from '../work';

/**
 * `request` is the name under which `who` sent the step. `out`: the server has not stored it yet.
 * `gone`: the step had no result. `stands`: the server has reported that it cannot be undone.
 */
type Sent = { type: 'sent'; request: string; who: string; out: boolean; gone?: boolean; stands?: boolean };

/** A step that only the page knows. */
export interface OwnStep {
  type: 'own';
  name: string;
  /** Whether the step is still valid. The questions change with each round. */
  stands(): boolean;
  /** `chosen`: the value of the store's counter when the user pressed the key. */
  back(chosen: number): void | Promise<void>;
  again(chosen: number): void | Promise<void>;
}
type Step = Sent | OwnStep;

/**
 * An undo or redo step that was sent. It moves from one list to the other. `step` is the step that
 * it reverses, if this page knows it.
 */
interface StepBack {
  path: string;
  step?: Sent;
  back: Sent;
  from: Step[];
  to: Step[];
  passed: boolean;
}

function forget(steps: Step[], step: Step): void {
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
  private goesOn = '';
  /**
   * The changes of other users, as reported by the server. Undo skips the steps that these changes
   * block.
   */
  private passed: { id: number; version: number }[] = [];

  constructor(
    private readonly store: Store,
    private readonly queue: ChangeQueue,
    private readonly map: GroundMap,
    private readonly told: Told,
    private readonly work: Work,
  ) {}

  /** Sends a change. It counts as a step at once, and its undo may wait behind it. */
  async send(method: Change['method'], path: string, body: Record<string, unknown>, shape?: Fields): Promise<Outcome> {
    const step = this.named();
    this.remember(step);
    const outcome = await this.queue.send(method, path, { ...body, who: step.who }, step.request, shape);
    this.came(outcome.status === 'stored', step, this.done);
    return outcome;
  }

  remember(step: Step): void {
    this.put(this.done, step);
    this.undone = [];
    this.goesOn = '';
    this.forgetRefused();
  }

  skipped({ round, index }: Hypothesis): void {
    const skip = (on: boolean): void => {
      if (on) this.store.skipped.add(index);
      else this.store.skipped.delete(index);
      this.store.tell('hypotheses');
    };
    skip(true);
    this.remember({
      type: 'own',
      name: 'Skip',
      stands: () => round === this.store.round,
      back: (chosen) => {
        skip(false);
        this.showHypothesis(index, chosen);
      },
      again: (chosen) => {
        skip(true);
        if (chosen === this.store.chosen) this.work.nextQuestion();
      },
    });
  }

  /** `put` shows the hypothesis in another shape. */
  nudged(index: number, before: Box, now: Box, put: (index: number, box: Box) => void): void {
    const to = (box: Box) => (chosen: number): void => {
      put(index, boxFields(box));
      this.showHypothesis(index, chosen);
    };
    const { round } = this.store;
    const stands = (): boolean => round === this.store.round || this.store.hypotheses.has(index);
    this.remember({ type: 'own', name: 'Move', stands, back: to(before), again: to(now) });
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
    if (last?.type !== 'own') return this.takeBack(path, last, from, to);
    this.put(to, last);
    const { chosen } = this.store;
    return this.after(async () => {
      await (undoes ? last.back(chosen) : last.again(chosen));
      this.told.say(`${last.name} ${undoes ? 'undone' : 'redone'}`);
    });
  }

  /** Another page has made a change. The page warns the user before it undoes such a change. */
  doneElsewhere(): void {
    this.goesOn = '';
  }

  private named(): Sent {
    return { type: 'sent', request: this.queue.newName(), who: this.store.who, out: true };
  }

  // Runs one display after another, so that the result of an earlier step does not replace that of
  // a later one.
  private after(show: () => Promise<void>): Promise<void> {
    this.running = this.running.then(show, show);
    return this.running;
  }

  // Returns the last step that is not blocked.
  private last(steps: Step[]): Step | undefined {
    for (const step of [...steps].reverse()) {
      if (step.type === 'sent' && step.stands) continue;
      forget(steps, step);
      if (step.type === 'sent' || step.stands()) return step;
    }
    return undefined;
  }

  private put(steps: Step[], step: Step): void {
    this.order.set(step, ++this.count);
    steps.push(step);
  }

  private putBack(steps: Step[], step: Step): void {
    if (step.type === 'sent' && step.gone) return;
    const at = this.order.get(step)!;
    const later = steps.findIndex((other) => this.order.get(other)! > at);
    steps.splice(later < 0 ? steps.length : later, 0, step);
  }

  private forgetRefused(): void {
    this.passed = [];
    for (const step of [...this.done, ...this.undone]) if (step.type === 'sent') step.stands = false;
  }

  // Reverses the last step of this user. `step` is that step if this page knows it. Otherwise it is
  // a step of this page before the reload. The step moves to the other list at once, and back if
  // there is no result.
  private takeBack(path: string, step: Sent | undefined, from: Step[], to: Step[]): Promise<void> {
    const back = this.named();
    const { chosen } = this.store;
    const word = path.endsWith('undo') ? 'undone' : 'redone';
    this.put(to, back);
    const { passed } = this;
    // If this page's blocked steps are skipped, the server searches earlier steps of this page.
    let last = this.goesOn === path ? '' : this.queue.names;
    if (step?.who === back.who && (step.out || passed.length === 0)) last = step.request;
    const way = { path, step, back, from, to, passed: passed.length > 0 };
    const sent = this.queue.send('POST', path, { who: back.who, last, passed }, back.request).then((outcome) => {
      this.settle(way, outcome); // at once, because the next key press depends on it
      return outcome;
    });
    return this.after(async () => this.tell(word, await sent, chosen));
  }

  private came(stored: boolean, step: Sent, list: Step[]): void {
    step.out = false;
    step.gone = !stored;
    if (!stored) forget(list, step);
  }

  private settle({ path, step, back, from, to, passed }: StepBack, outcome: Outcome): void {
    const changed = outcome.status === 'stored' && (outcome.labels.length > 0 || outcome.classes !== undefined);
    this.came(changed, back, to);
    if (changed && outcome.took !== step?.request) {
      if (step && passed) {
        step.stands = true; // it lies under a blocked step
        this.putBack(from, step);
      }
      for (const taken of from.filter((s) => s.type === 'sent' && s.request === outcome.took)) forget(from, taken);
    }
    if (outcome.status === 'conflict') {
      const { id, version } = outcome.about === 'label' ? outcome.current : { id: 0, version: outcome.current.version };
      this.passed = [...this.passed, { id, version }];
      if (step) step.stands = true;
    }
    if (step && (outcome.status === 'conflict' || (outcome.status === 'behind' && this.goesOn !== path))) this.putBack(from, step);
    if (outcome.status === 'elsewhere') [from.length, this.goesOn] = [0, path];
  }

  private async tell(word: string, outcome: Outcome, chosen: number): Promise<void> {
    if (outcome.status === 'behind') return; // the page has already reported the earlier step
    if (outcome.status === 'conflict') {
      if (outcome.about === 'label') this.store.take(outcome.current);
      const why = outcome.about === 'label' ? `${outcome.current.who} has changed label ${outcome.current.id} since` : 'the classes are in use or were changed since';
      return this.told.warn(`Not ${word}: ${why}. Press the key again to skip this step`);
    }
    if (outcome.status === 'elsewhere')
      return this.told.warn(`Not ${word}: ${outcome.message}. Press the key again to continue`);
    const labels = this.work.take(outcome);
    if (outcome.status === 'stored') await this.show(word, labels, outcome.classes !== undefined, chosen);
  }

  private async show(word: string, labels: Label[], classes: boolean, chosen: number): Promise<void> {
    await Promise.all([this.work.loadHypotheses(), this.work.loadProgress()]);
    const last = labels[labels.length - 1];
    if (classes) return this.told.say(`Classes: change ${word}`);
    if (!last) this.told.say(`Nothing to ${word === 'undone' ? 'undo' : 'redo'}`);
    else this.told.say(`${labels.length > 1 ? `${labels.length} labels` : `Label ${last.id}`}: change ${word}`);
    if (last && !isOnGround(last)) return this.told.windows(labels);
    if (!last || chosen !== this.store.chosen) return; // the user has selected something else since
    if (!last.deleted) {
      this.work.questions.bring({ type: 'label', id: last.id }, chosen);
      this.map.showSelected(false);
    } else {
      const again = this.hypothesisAt(middleOf(last.corners));
      if (again) this.showHypothesis(again.index, chosen);
      else this.store.selectAfter(chosen, { type: 'none' });
      this.map.showPlace(last.corners);
    }
  }

  private hypothesisAt([x, y]: Point): Hypothesis | undefined {
    return [...this.store.hypotheses.values()].find((h) => Math.hypot(h.x - x, h.y - y) < 0.3);
  }

  private showHypothesis(index: number, chosen: number): void {
    if (!this.store.hypotheses.has(index)) return;
    if (this.store.selectedHypothesis()?.index === index) return this.map.showSelected();
    if (this.work.questions.bring({ type: 'hypothesis', index }, chosen)) this.map.showSelected();
  }
}
