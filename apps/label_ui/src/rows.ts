// Rows of boxes: one more at the spacing of the last two, or all that lie between them.
import { boxOf, nextInRow, rowBetween } from './geometry';
import type { GroundMap } from './ground_map';
import { liesOnAny } from './overlap';
import type { Store } from './store';
import type { Box, Draft, Label } from './types';
import type { Told, Work } from './work';

const kMost = 200;
const kSamePlace = 0.5; // of the smaller: there is one already

export class Rows {
  constructor(
    private readonly store: Store,
    private readonly work: Work,
    private readonly map: GroundMap,
    private readonly told: Told,
  ) {}

  repeat(count: number): Promise<void> {
    return this.work.row(() => this.addAtSpacing(count));
  }

  /** Between the two boxes that were selected last, where nothing is yet. */
  fill(): Promise<void> {
    return this.work.row(() => this.fillBetween());
  }

  private async addAtSpacing(count: number): Promise<void> {
    const [last, before] = await this.lastTwo();
    let box = last && boxOf(last);
    if (!last || !box) return this.told.warn('repeat: select a box first');
    let earlier = before && boxOf(before);
    const boxes: Box[] = [];
    for (let i = 0; i < Math.min(kMost, count); ++i) {
      const next = nextInRow(box, earlier);
      boxes.push(next);
      [earlier, box] = [box, next];
    }
    await this.keep(boxes, last.kind);
  }

  private async fillBetween(): Promise<void> {
    const [last, before] = await this.lastTwo();
    const [end, begin] = [last && boxOf(last), before && boxOf(before)];
    if (!last || !end || !begin) return this.told.warn('fill: select one end of the row, then the other');
    const there = this.store.active().filter((label) => label.kind === last.kind).map((label) => label.corners);
    const all = rowBetween(begin, end);
    const boxes = all.filter((box) => !liesOnAny(box, there, kSamePlace));
    if (boxes.length === 0) return this.told.warn('fill: nothing is missing between the last two');
    if (boxes.length > kMost) return this.told.warn(`fill: ${boxes.length} would lie between, at most ${kMost} can`);
    const stored = await this.keep(boxes, last.kind);
    this.store.select({ type: 'label', id: last.id }); // from where `repeat` goes on
    this.map.showSelected(false);
    if (stored > 0) this.told.say(`${stored} between stored`);
  }

  // What is selected, and the one of its class that was selected before.
  private async lastTwo(): Promise<[Label | null, Label | null]> {
    await this.work.settle();
    const last = this.store.selectedLabel();
    const earlier = this.store.before === null ? undefined : this.store.labels.get(this.store.before);
    return [last, last && earlier && !earlier.deleted && earlier.kind === last.kind ? earlier : null];
  }

  private async keep(boxes: Box[], kind: string): Promise<number> {
    const drafts = boxes.map((box): Draft => ({ ...box, shape: 'box', kind, source: 'drawn', score: 1, note: '' }));
    const labels = await this.work.createAll(drafts);
    for (const label of labels) this.store.select({ type: 'label', id: label.id });
    this.map.showSelected(false);
    await this.work.loadHypotheses();
    return labels.length;
  }
}
