// Adds rows of boxes: further boxes at the spacing of the last two, or the boxes between them.
import { boxOf, nextInRow, rowBetween } from './geometry';
import type { GroundMap } from './ground_map';
import { liesOnAny } from './overlap';
import type { Store } from '../store';
import type { TrailEntry } from '../trail';
import type { Box, Draft, Label } from '../types';
import type { Notifier, Work } from '../work';

const kMost = 200;
const kSamePlace = 0.5; // overlap as a share of the smaller box: the place is occupied

/** The state at the time of the request. The row may have to wait for earlier actions. */
interface Row {
  /**
   * The places that were selected or drawn. The row starts from the last place. Empty if no label
   * is there.
   */
  from: readonly TrailEntry[];
  /** The labels that the row ends with. */
  ends: [TrailEntry, TrailEntry];
  selectionCount: number;
}

export class Rows {
  constructor(
    private readonly store: Store,
    private readonly work: Work,
    private readonly map: GroundMap,
    private readonly notifier: Notifier,
  ) {}

  repeat(count: number): Promise<void> {
    return this.begin((row) => this.addAtSpacing(row, count));
  }

  /** Adds the missing boxes between the two boxes selected last. */
  fill(): Promise<void> {
    return this.begin((row) => this.fillBetween(row));
  }

  private begin(make: (row: Row) => Promise<boolean>): Promise<void> {
    const { trail, selectionCount } = this.store;
    const places = trail.list();
    const last = places.at(-1);
    const isSelected = last && (last.id === null || last.id === this.store.selectedLabel()?.id);
    const row: Row = { from: isSelected ? places : [], ends: [trail.add(null), trail.add(null)], selectionCount };
    return this.work.row(async () => {
      if (!(await make(row))) row.ends.forEach((place) => trail.remove(place));
    });
  }

  private async addAtSpacing(row: Row, count: number): Promise<boolean> {
    const [last, before] = await this.lastTwo(row);
    let box = last && boxOf(last);
    if (!last || !box) return this.refuse('Repeat: select a box first');
    let earlier = before && boxOf(before);
    const boxes: Box[] = [];
    for (let i = 0; i < Math.min(kMost, count); ++i) {
      const next = nextInRow(box, earlier);
      boxes.push(next);
      [earlier, box] = [box, next];
    }
    const ids = [last.id, ...(await this.createBoxes(boxes, last.kind))];
    return this.selectEnd(row, ids);
  }

  private async fillBetween(row: Row): Promise<boolean> {
    const [last, before] = await this.lastTwo(row);
    const [end, begin] = [last && boxOf(last), before && boxOf(before)];
    if (!last || !end || !begin) return this.refuse('Fill row: select one end of the row, then the other end');
    const existing = this.store.active().filter((label) => label.kind === last.kind).map((label) => label.corners);
    const all = rowBetween(begin, end);
    const boxes = all.filter((box) => !liesOnAny(box, existing, kSamePlace));
    if (boxes.length === 0) return this.refuse('Fill row: no box is missing between the last two selected boxes');
    if (boxes.length > kMost) return this.refuse(`Fill row: ${boxes.length} boxes are missing, at most ${kMost} can be added at once`);
    const ids = await this.createBoxes(boxes, last.kind);
    if (!(await this.selectEnd(row, ids.length > 0 ? [...ids, last.id] : []))) return false; // `repeat` continues from the end of the row
    this.notifier.status(`${ids.length} boxes saved`);
    return true;
  }

  // Returns the start label of the row, and the label that was selected before it and still exists.
  private async lastTwo({ from }: Row): Promise<[Label | null, Label | null]> {
    await this.work.settle();
    const places = [...from].reverse();
    const labelAt = (place: TrailEntry | undefined): Label | null => {
      const label = place?.id == null ? undefined : this.store.labels.get(place.id);
      return label && !label.deleted ? label : null;
    };
    const last = labelAt(places[0]);
    const earlier = labelAt(places.find((place) => place.id !== last?.id && labelAt(place)));
    return [last, last && earlier?.kind === last.kind ? earlier : null];
  }

  private async createBoxes(boxes: Box[], kind: string): Promise<number[]> {
    const drafts = boxes.map((box): Draft => ({ ...box, shape: 'box', kind, source: 'drawn', score: 1, note: '' }));
    return (await this.work.createAll(drafts)).map((label) => label.id);
  }

  // Selects the last label of the row, unless the user has selected something else in the meantime.
  private async selectEnd({ ends, selectionCount }: Row, ids: number[]): Promise<boolean> {
    const [before, last] = ids.slice(-2);
    if (last === undefined) return false;
    [ends[0].id, ends[1].id] = [before, last];
    if (this.store.selectUnlessChanged(selectionCount, { type: 'label', id: last })) this.map.showSelected(false);
    await this.work.loadHypotheses();
    return true;
  }

  private refuse(reason: string): false {
    this.notifier.warn(reason);
    return false;
  }
}
