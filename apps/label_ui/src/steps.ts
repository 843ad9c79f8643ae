// Undo and redo: skips are the page's own, everything else is taken back by the server.
import { middleOf } from './geometry';
import type { GroundMap } from './ground_map';
import type { Change, ChangeQueue, Outcome } from './server';
import type { Store } from './store';
import { isOnGround, type Hypothesis, type Label, type Point } from './types';
import type { Told, Work } from './work';

/** `request`: the name under which it was sent, by `who`. */
type Sent = { type: 'sent'; request: string; who: string };
type Skipped = { type: 'skipped'; round: number; index: number };
type Step = Sent | Skipped;

function forget(steps: Step[], step: Step): void {
  if (steps.includes(step)) steps.splice(steps.indexOf(step), 1);
}

export class Steps {
  private done: Step[] = [];
  private undone: Step[] = [];
  private running: Promise<void> = Promise.resolve();
  /** Where the next step back may take what another page has done: it was told. */
  private goesOn = '';

  constructor(
    private readonly store: Store,
    private readonly queue: ChangeQueue,
    private readonly map: GroundMap,
    private readonly told: Told,
    private readonly work: Work,
  ) {}

  /** Sends a change. It is a step at once: what takes it back may wait behind it. */
  async send(method: Change['method'], path: string, body: Record<string, unknown>): Promise<Outcome> {
    const step = this.named();
    this.remember(step);
    const outcome = await this.queue.send(method, path, { ...body, who: step.who }, step.request);
    if (outcome.status !== 'stored') forget(this.done, step);
    return outcome;
  }

  skipped({ round, index }: Hypothesis): void {
    this.remember({ type: 'skipped', round, index });
  }

  undo(): Promise<void> {
    this.work.flush();
    const step = this.last(this.done);
    if (step?.type !== 'skipped') return this.takeBack('api/undo', step, this.done, this.undone);
    this.undone.push(step);
    return this.after(async () => {
      this.store.skipped.delete(step.index);
      this.store.tell('hypotheses');
      if (this.store.hypotheses.has(step.index)) this.showHypothesis(this.store.hypotheses.get(step.index)!);
      this.told.say('skip taken back');
    });
  }

  redo(): Promise<void> {
    this.work.flush();
    const step = this.last(this.undone);
    if (step?.type !== 'skipped') return this.takeBack('api/redo', step, this.undone, this.done);
    this.done.push(step);
    return this.after(async () => {
      this.store.skipped.add(step.index);
      this.store.tell('hypotheses');
      this.work.nextQuestion();
    });
  }

  /** Something was done in another page: that is not taken back before it was told. */
  doneElsewhere(): void {
    this.goesOn = '';
  }

  private named(): Sent {
    return { type: 'sent', request: this.queue.newName(), who: this.store.who };
  }

  private remember(step: Step): void {
    this.done.push(step);
    this.undone = [];
    this.goesOn = '';
  }

  // One after another: what a step shows is not what an earlier one shows later.
  private after(show: () => Promise<void>): Promise<void> {
    this.running = this.running.then(show, show);
    return this.running;
  }

  // A skip of an older round is no step any more: there its index meant another thing.
  private last(steps: Step[]): Step | undefined {
    let step = steps.pop();
    while (step?.type === 'skipped' && step.round !== this.store.round) step = steps.pop();
    return step;
  }

  // What this person did last: `step` where this page knows it, else only what this page did before it
  // was loaded again. It goes from one list to the other at once, and back where nothing came of it.
  private takeBack(path: string, step: Sent | undefined, from: Step[], to: Step[]): Promise<void> {
    const back = this.named();
    const place = from.length;
    to.push(back);
    let last = this.goesOn === path ? '' : this.queue.names;
    if (step?.who === back.who) last = step.request;
    const sent = this.queue.send('POST', path, { who: back.who, last }, back.request);
    return this.after(async () => {
      const outcome = await sent;
      const changed = outcome.status === 'stored' && (outcome.labels.length > 0 || outcome.classes !== undefined);
      if (!changed) forget(to, back);
      if (outcome.status === 'conflict' && step) from.splice(place, 0, step); // it still is the last
      if (outcome.status === 'elsewhere') [from.length, this.goesOn] = [0, path];
      await this.tell(path.endsWith('undo') ? 'undone' : 'redone', outcome);
    });
  }

  private async tell(word: string, outcome: Outcome): Promise<void> {
    if (outcome.status === 'conflict') {
      if (outcome.about === 'label') this.store.take(outcome.current);
      const what = outcome.about === 'label' ? `label ${outcome.current.id}` : 'the classes';
      return this.told.warn(`not ${word}: ${outcome.current.who} has changed ${what} since`);
    }
    if (outcome.status === 'elsewhere')
      return this.told.warn(`not ${word}: ${outcome.message}; the same key again goes on with that`);
    const labels = this.work.take(outcome);
    if (outcome.status === 'stored') await this.show(word, labels, outcome.classes !== undefined);
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
