// Decides when the page shows a question. A question appears after a round that the user has
// requested, and after each answer. A question never interrupts the user's current work.
import type { GroundMap } from './ground_map';
import { fetchJson } from '../sync/server';
import type { Selection, Store } from '../store';
import type { Notifier } from '../work';

interface Work {
  /** Waits until all started actions are complete and stored. */
  allDone(): Promise<void>;
  loadHypotheses(): Promise<void>;
  loadProgress(): Promise<void>;
}

export class Questions {
  /** Returns whether the user has started to draw a shape. */
  drawingBegun = (): boolean => false;
  /** The user has requested a round, and a question after it. */
  private isRoundRequested = false;
  /** The round has ended, and the page has not shown its question yet. */
  private isQuestionWaiting = false;
  /**
   * The selected question, if the page has selected it. Null if the user has selected the object.
   */
  private question: Selection | null = null;
  /**
   * The object that an undo or redo step has selected. The page shows it, but the user is not
   * working on it.
   */
  private restored: Selection | null = null;

  constructor(
    private readonly store: Store,
    private readonly map: GroundMap,
    private readonly notifier: Notifier,
    private readonly work: Work,
  ) {
    store.isUserEditing = () => store.selection !== this.restored;
    store.onQuestionClosed = (selection) => this.questionClosed(selection);
  }

  /** Returns whether the page (not the user) has selected the current object. */
  isQuestionSelected(): boolean {
    return this.store.selection === this.question;
  }

  /** Shows the most useful question at the centre. Starts a round if no question is left. */
  next(): void {
    this.isQuestionWaiting = false;
    const [next] = this.store.openQuestions();
    if (next !== undefined) {
      this.question = { type: 'hypothesis', index: next };
      this.store.select(this.question);
      this.map.showSelected();
      return;
    }
    this.store.select({ type: 'none' });
    if (this.store.round > 0 && this.store.hypothesisKind) void this.learn(this.store.hypothesisKind);
  }

  async learn(kind: string): Promise<void> {
    await this.work.allDone();
    this.isRoundRequested = true;
    this.isQuestionWaiting = false;
    this.store.select({ type: 'none' }); // a question will follow
    try {
      await fetchJson('POST', 'api/learn', { kind, map: this.store.start.map });
      this.notifier.status('Training');
    } catch (fault) {
      this.isRoundRequested = false; // a later round of another user is not this user's request
      this.notifier.warn((fault as Error).message);
    }
  }

  /**
   * Handles the end of a round. Another user may have requested the round while a question was open
   * on this page.
   */
  async learned(error: string): Promise<void> {
    if (error) this.notifier.warn(`Training failed: ${error}`);
    await Promise.all([this.work.loadHypotheses(), this.work.loadProgress()]);
    const last = this.store.progress.rounds.at(-1);
    if (!error && last) this.notifier.status(`Round ${last.round}: ${last.found} likely`);
    const open = this.store.selectedHypothesis();
    const answering = open !== null && this.isQuestionSelected();
    const wanted = this.isRoundRequested || answering;
    this.isRoundRequested = false;
    // The user may have answered the older question during the requests above. Then the next
    // question is already open.
    if (!wanted || (answering && open.round === this.store.round)) return;
    this.isQuestionWaiting = true;
    this.showWaiting();
  }

  // Another user has answered the question that was open on this page.
  private questionClosed(selection: Selection): void {
    if (selection !== this.question) return;
    this.isQuestionWaiting = true;
    this.showWaiting();
  }

  /**
   * Selects the result of an undo or redo step, unless the user has selected something since.
   * Returns whether it selected the result.
   */
  selectResult(selection: Selection, countBefore: number): boolean {
    if (!this.store.selectUnlessChanged(countBefore, selection)) return false;
    if (selection.type === 'label') this.store.trail.add(selection.id);
    this.restored = selection;
    // If the step reopens a question of this round, the page asks it again. Its answer brings the
    // next question.
    if (selection.type === 'hypothesis' && this.store.openQuestions().includes(selection.index)) this.question = selection;
    return true;
  }

  /** Declares that the user is working on the selected object. */
  setUserEditing(): void {
    this.restored = null;
  }

  /** Deselects the object and shows a waiting question. */
  deselect(): void {
    this.store.select({ type: 'none' });
    this.showWaiting();
  }

  /** Shows a waiting question, unless the user is working on an object. */
  showWaiting(): void {
    if (!this.isQuestionWaiting) return;
    const { selection } = this.store;
    if (this.drawingBegun() || (selection.type !== 'none' && selection !== this.restored))
      return this.notifier.status('The next question is ready: press n, or Esc to finish here');
    this.isQuestionWaiting = false;
    if (this.store.openQuestions().length > 0) this.next();
    else this.notifier.status('No questions left');
  }
}
