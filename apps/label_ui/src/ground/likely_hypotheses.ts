// Handles many likely hypotheses at once. Accepts the visible ones, and then moves to the area with
// the most remaining ones.
import { answerOf, cornersOf } from './geometry';
import type { GroundMap } from './ground_map';
import { overlapShare } from './overlap';
import type { Store } from '../store';
import type { Hypothesis } from '../types';
import type { Notifier, Work } from '../work';

const kMostOverlap = 0.25; // share of the smaller of two neighbours, with an allowance for careless drawing

export class LikelyHypotheses {
  constructor(
    private readonly store: Store,
    private readonly map: GroundMap,
    private readonly notifier: Notifier,
    private readonly work: Work,
  ) {}

  /** Accepts all likely hypotheses in the visible part of the map, as one step of undo. */
  acceptInView(): Promise<void> {
    return this.work.track(this.acceptVisible());
  }

  private async acceptVisible(): Promise<void> {
    const { store, work } = this;
    const seen = store.likely().filter((h) => this.map.isInView(cornersOf(h)));
    if (seen.length === 0) return this.notifier.warn('No likely hypothesis is completely in view');
    const kind = store.hypothesisKind;
    const free = this.withoutOverlap(seen, kind);
    if (free.length === 0) return this.notifier.warn('The likely hypotheses in view overlap other objects: correct or reject them');
    store.select({ type: 'none' });
    // The hypotheses disappear at once, so that a second key press does not accept them again. A
    // hypothesis that the server refuses returns.
    for (const h of free) store.removeHypothesis(h.index);
    const stored = await work.createAll(free.map((h) => answerOf(h, true)));
    const left = seen.length - free.length;
    this.notifier.status(`${stored.length} accepted${left > 0 ? `, ${left} left because they overlap other objects` : ''}`);
    await Promise.all([work.loadHypotheses(), work.loadProgress()]);
    work.questions.showWaiting();
  }

  // Returns the most likely hypotheses first, without those that overlap an object of their class.
  // Two objects cannot be in one place.
  private withoutOverlap(list: Hypothesis[], kind: string): Hypothesis[] {
    const taken = this.store.active().filter((label) => label.kind === kind).map((label) => label.corners);
    return [...list].sort((a, b) => b.probability - a.probability).filter((h) => {
      const corners = cornersOf(h);
      const free = taken.every((other) => overlapShare(corners, other) < kMostOverlap);
      if (free) taken.push(corners);
      return free;
    });
  }

  /** Moves to the area with the most remaining hypotheses. */
  showRest(): void {
    this.store.select({ type: 'none' });
    const left = this.store.likely();
    if (!this.map.showDensestArea(left.map(cornersOf))) this.notifier.warn('No likely hypothesis is left');
    else this.notifier.status(`${left.length} likely hypotheses left`);
    this.work.questions.showWaiting();
  }
}
