// Undo and redo: skips are the page's own, everything else is taken back by the server.
import { middleOf } from './geometry';
import type { GroundMap } from './ground_map';
import type { ChangeQueue } from './server';
import type { Store } from './store';
import { isOnGround, type Hypothesis, type Label, type Point } from './types';
import type { Told, Work } from './work';

/** `request`: the name under which it was stored, by `who`. */
type Done = { type: 'stored'; request: string; who: string } | { type: 'skipped'; round: number; index: number };

export class Steps {
  private done: Done[] = [];
  private undone: Done[] = [];
  private running: Promise<void> = Promise.resolve();

  constructor(
    private readonly store: Store,
    private readonly queue: ChangeQueue,
    private readonly map: GroundMap,
    private readonly told: Told,
    private readonly work: Work,
  ) {}

  remember(step: Done): void {
    this.done.push(step);
    this.undone = [];
  }

  /** One after another: what a step shows is not what an earlier one shows later. */
  undo(): Promise<void> {
    return this.after(() => this.undoOne());
  }

  redo(): Promise<void> {
    return this.after(() => this.redoOne());
  }

  private after(step: () => Promise<void>): Promise<void> {
    this.running = this.running.then(step, step);
    return this.running;
  }

  private async undoOne(): Promise<void> {
    await this.work.settle();
    const step = this.last(this.done);
    if (step?.type === 'skipped') {
      this.store.skipped.delete(step.index);
      this.undone.push(step);
      this.store.tell('hypotheses');
      if (this.store.hypotheses.has(step.index))
        this.showHypothesis(this.store.hypotheses.get(step.index)!);
      return this.told.say('skip taken back');
    }
    await this.takeBack('api/undo', step, this.done, this.undone);
  }

  private async redoOne(): Promise<void> {
    await this.work.settle();
    const step = this.last(this.undone);
    if (step?.type === 'skipped') {
      this.store.skipped.add(step.index);
      this.done.push(step);
      this.store.tell('hypotheses');
      return this.work.nextQuestion();
    }
    await this.takeBack('api/redo', step, this.undone, this.done);
  }

  // A skip of an older round is no step any more: there its index meant another thing.
  private last(steps: Done[]): Done | undefined {
    let step = steps.pop();
    while (step?.type === 'skipped' && step.round !== this.store.round) step = steps.pop();
    return step;
  }

  // Of what this person did, in this page or another: `step` is the last of this one, from where it
  // goes to where it is taken back from.
  private async takeBack(path: string, step: Done | undefined, from: Done[], to: Done[]): Promise<void> {
    const word = path.endsWith('undo') ? 'undone' : 'redone';
    const { who } = this.store;
    const mine = step?.type === 'stored' && step.who === who ? { last: step.request } : {};
    const outcome = await this.queue.send('POST', path, { who, ...mine });
    if (outcome.status === 'conflict') {
      if (step) from.push(step); // it still is the last
      if (outcome.about === 'label') this.store.take(outcome.current);
      const what = outcome.about === 'label' ? `label ${outcome.current.id}` : 'the classes';
      return this.told.warn(`not ${word}: ${outcome.current.who} has changed ${what} since`);
    }
    if (outcome.status === 'elsewhere') {
      from.length = 0; // once more goes on with what was done elsewhere
      return this.told.warn(`not ${word}: ${outcome.message}; the same key again goes on with that`);
    }
    const labels = this.work.take(outcome);
    if (outcome.status !== 'stored') return;
    if (labels.length > 0 || outcome.classes) to.push({ type: 'stored', request: outcome.request, who });
    await this.show(word, labels, outcome.classes !== undefined);
  }

  private async show(word: string, labels: Label[], classes: boolean): Promise<void> {
    await Promise.all([this.work.loadHypotheses(), this.work.loadProgress()]);
    const last = labels[labels.length - 1];
    if (classes) return this.told.say(`${word}: a change of the classes`);
    if (!last) this.told.say(`nothing to be ${word}`);
    else this.told.say(`${word}: ${labels.length > 1 ? `${labels.length} labels` : `label ${last.id}`}`);
    if (last && !isOnGround(last)) return this.told.windows(labels);
    if (last && !last.deleted) {
      this.work.questions.bring({ type: 'label', id: last.id });
      this.map.showSelected(false);
    } else if (last) {
      const again = this.hypothesisAt(middleOf(last.corners));
      if (again) this.showHypothesis(again);
      else this.store.select({ type: 'none' });
      this.map.showPlace(last.corners);
    }
  }

  private hypothesisAt([x, y]: Point): Hypothesis | undefined {
    return [...this.store.hypotheses.values()].find((h) => Math.hypot(h.x - x, h.y - y) < 0.3);
  }

  private showHypothesis(h: Hypothesis): void {
    this.work.questions.bring({ type: 'hypothesis', index: h.index });
    this.map.showSelected();
  }
}
