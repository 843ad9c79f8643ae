// Undo and redo: skips are the page's own, everything else is taken back by the server.
import { middleOf } from './geometry';
import type { GroundMap } from './ground_map';
import type { ChangeQueue } from './server';
import type { Store } from './store';
import { isOnGround, type Hypothesis, type Point } from './types';
import type { Told, Work } from './work';

type Done = { type: 'stored' } | { type: 'skipped'; round: number; index: number };

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
    if (await this.takeBack('api/undo')) this.undone.push({ type: 'stored' });
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
    if (await this.takeBack('api/redo')) this.done.push({ type: 'stored' });
  }

  // A skip of an older round is no step any more: there its index meant another thing.
  private last(steps: Done[]): Done | undefined {
    let step = steps.pop();
    while (step?.type === 'skipped' && step.round !== this.store.round) step = steps.pop();
    return step;
  }

  /** Whether there was something. */
  private async takeBack(path: string): Promise<boolean> {
    const word = path.endsWith('undo') ? 'undone' : 'redone';
    const outcome = await this.queue.send('POST', path, { who: this.store.who });
    if (outcome.status === 'conflict') {
      if (outcome.about === 'label') this.store.take(outcome.current);
      const what = outcome.about === 'label' ? `label ${outcome.current.id}` : 'the classes';
      this.told.warn(`not ${word}: ${outcome.current.who} has changed ${what} since`);
      return false;
    }
    const labels = this.work.take(outcome);
    if (outcome.status !== 'stored') return false;
    await Promise.all([this.work.loadHypotheses(), this.work.loadProgress()]);
    const last = labels[labels.length - 1];
    if (outcome.classes) {
      this.told.say(`${word}: a change of the classes`);
      return true;
    }
    if (!last) this.told.say(`nothing to be ${word}`);
    else this.told.say(`${word}: ${labels.length > 1 ? `${labels.length} labels` : `label ${last.id}`}`);
    if (last && !isOnGround(last)) {
      this.told.windows(labels);
      return true;
    }
    if (last && !last.deleted) {
      this.work.questions.bring({ type: 'label', id: last.id });
      this.map.showSelected(false);
    } else if (last) {
      const again = this.hypothesisAt(middleOf(last.corners));
      if (again) this.showHypothesis(again);
      else this.store.select({ type: 'none' });
      this.map.showPlace(last.corners);
    }
    return labels.length > 0;
  }

  private hypothesisAt([x, y]: Point): Hypothesis | undefined {
    return [...this.store.hypotheses.values()].find((h) => Math.hypot(h.x - x, h.y - y) < 0.3);
  }

  private showHypothesis(h: Hypothesis): void {
    this.work.questions.bring({ type: 'hypothesis', index: h.index });
    this.map.showSelected();
  }
}
