// When which question comes: by itself after a round that the labeller has asked for, the next one
// after an answer, and never into what the labeller is at.
import type { GroundMap } from './ground_map';
import { fetchJson } from '../sync/server';
import type { Selection, Store } from '../store';
import type { Told } from '../work';

interface Work {
  /** When all that was begun is done and stored. */
  allDone(): Promise<void>;
  loadHypotheses(): Promise<void>;
  loadProgress(): Promise<void>;
}

export class Questions {
  /** Whether a shape has been begun. */
  drawingBegun = (): boolean => false;
  /** A round was asked for, and with it a question. */
  private wanted = false;
  /** The round has ended, and its question has not come yet. */
  private waits = false;
  /** The question that came by itself, for as long as it is selected; what the labeller has chosen is another matter. */
  private asked: Selection | null = null;
  /** What a step taken back or done again has selected: shown, but not what the labeller is at. */
  private brought: Selection | null = null;

  constructor(
    private readonly store: Store,
    private readonly map: GroundMap,
    private readonly told: Told,
    private readonly work: Work,
  ) {
    store.isHeld = () => store.selection !== this.brought;
    store.dropped = (selection) => this.dropped(selection);
  }

  /** Whether what is selected came by itself. */
  came(): boolean {
    return this.store.selection === this.asked;
  }

  /** Brings the most useful question to the centre; learns again when all have been asked. */
  next(): void {
    this.waits = false;
    const [next] = this.store.openQuestions();
    if (next !== undefined) {
      this.asked = { type: 'hypothesis', index: next };
      this.store.select(this.asked);
      this.map.showSelected();
      return;
    }
    this.store.select({ type: 'none' });
    if (this.store.round > 0 && this.store.hypothesisKind) void this.learn(this.store.hypothesisKind);
  }

  async learn(kind: string): Promise<void> {
    await this.work.allDone();
    this.wanted = true;
    this.waits = false;
    this.store.select({ type: 'none' }); // a question comes in its place
    try {
      await fetchJson('POST', 'api/learn', { kind, map: this.store.start.map });
      this.told.say('learning');
    } catch (fault) {
      this.wanted = false; // a round that somebody else asks for is another
      this.told.warn((fault as Error).message);
    }
  }

  /** A round has ended; somebody else may have asked for it while a question was open here. */
  async learned(error: string): Promise<void> {
    if (error) this.told.warn(`learning: ${error}`);
    await Promise.all([this.work.loadHypotheses(), this.work.loadProgress()]);
    const last = this.store.progress.rounds.at(-1);
    if (!error && last) this.told.say(`round ${last.round}: ${last.found} likely`);
    const open = this.store.selectedHypothesis();
    const answering = open !== null && this.came();
    const wanted = this.wanted || answering;
    this.wanted = false;
    // The labeller may have answered the older question while this was told: the next one has come.
    if (!wanted || (answering && open.round === this.store.round)) return;
    this.waits = true;
    this.bringWaiting();
  }

  // Somebody else has answered what was asked here.
  private dropped(selection: Selection): void {
    if (selection !== this.asked) return;
    this.waits = true;
    this.bringWaiting();
  }

  /** Selects what a step has brought back, unless the labeller has chosen something since; whether it did. */
  bring(selection: Selection, chosen: number): boolean {
    if (!this.store.selectAfter(chosen, selection)) return false;
    if (selection.type === 'label') this.store.trail.put(selection.id);
    this.brought = selection;
    // A question of this round that is open again is asked again: its answer brings the next one.
    if (selection.type === 'hypothesis' && this.store.openQuestions().includes(selection.index)) this.asked = selection;
    return true;
  }

  /** What is selected is what the labeller works on. */
  atWork(): void {
    this.brought = null;
  }

  /** Nothing is selected any more: a question that waited for that comes. */
  letGo(): void {
    this.store.select({ type: 'none' });
    this.bringWaiting();
  }

  /** A question that waits comes, unless the labeller is at something. */
  bringWaiting(): void {
    if (!this.waits) return;
    const { selection } = this.store;
    if (this.drawingBegun() || (selection.type !== 'none' && selection !== this.brought))
      return this.told.say('a question waits: Esc when this is done, or n');
    this.waits = false;
    if (this.store.openQuestions().length > 0) this.next();
    else this.told.say('nothing left to ask about');
  }
}
