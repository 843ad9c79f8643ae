// Drawing by clicks: three clicks for a box, any number for a polygon. Drawing by keys: each key
// press sets a corner at the middle of the map.
import { boxOfClicks, cornersOf, crossesItself, longWays } from './geometry';
import type { GroundMap } from './ground_map';
import type { Store } from '../store';
import type { Draft, Point } from '../types';

const kLeastSideM = 0.1;

export class Drawing {
  active = false;
  private points: Point[] = [];
  private pointer: Point | null = null;

  constructor(
    private readonly store: Store,
    private readonly map: GroundMap,
    private readonly finished: (draft: Draft) => void,
    private readonly hint: (text: string, bad?: boolean) => void,
  ) {}

  get begun(): boolean {
    return this.points.length > 0;
  }

  private get isBox(): boolean {
    return this.store.classOf(this.store.kind).shape === 'box';
  }

  start(): void {
    this.active = true;
    this.clear();
  }

  stop(): void {
    this.active = false;
    this.clear();
    this.hint('');
  }

  clear(): void {
    this.points = [];
    this.show();
  }

  move(p: Point): void {
    this.pointer = p;
    this.show();
  }

  add(p: Point): void {
    this.points.push(p);
    this.pointer = p;
    if (this.isBox && this.points.length === 3) return this.finishBox();
    this.show();
  }

  removeLastCorner(): void {
    this.points.pop();
    this.show();
  }

  /** Returns whether the last two corners are at the same place, to within `reach_m`. */
  isDoubleClick(reach_m: number): boolean {
    const [a, b] = this.points.slice(-2);
    return b !== undefined && Math.hypot(a[0] - b[0], a[1] - b[1]) <= reach_m;
  }

  /** Corners closer than `reach_m` to the previous corner count as the same corner. */
  finishPolygon(reach_m = 0.02): void {
    if (this.isBox) return;
    const corners = this.points.filter(
      (p, i) =>
        i === 0 || Math.hypot(p[0] - this.points[i - 1][0], p[1] - this.points[i - 1][1]) > reach_m,
    );
    if (corners.length < 3) return this.hint('A polygon needs at least three corners', true);
    if (crossesItself(corners)) return this.hint('The polygon crosses itself: Backspace removes the last corner', true);
    this.clear();
    this.finished({ ...this.draft(), shape: 'polygon', corners });
  }

  private finishBox(): void {
    const [a, b, c] = this.points;
    const box = boxOfClicks(a, b, c);
    this.clear();
    if (box.length < kLeastSideM || box.width < kLeastSideM)
      return this.hint('The box is too small: click both ends of a long side, then a point on the opposite side', true);
    this.finished({ ...this.draft(), ...longWays(box), shape: 'box' });
  }

  private draft(): Draft {
    return { kind: this.store.kind, source: 'drawn', score: 1, note: '', shape: 'box' };
  }

  private show(): void {
    const n = this.points.length;
    if (!this.active) return this.map.showSketch([], false);
    const title = this.store.classOf(this.store.kind).title;
    if (this.isBox)
      this.hint(
        [
          `${title}: click one end of a long side`,
          'Click the other end of this side',
          'Click a point on the opposite side',
        ][n],
      );
    else this.hint(n < 3 ? `${title}: click corner ${n + 1}` : 'Click the next corner, or press Enter to finish');
    const next = this.pointer && n > 0 ? [...this.points, this.pointer] : this.points;
    if (this.isBox && n === 2 && this.pointer)
      this.map.showSketch(cornersOf(boxOfClicks(this.points[0], this.points[1], this.pointer)), true);
    else this.map.showSketch(next, !this.isBox && next.length > 2);
  }
}
