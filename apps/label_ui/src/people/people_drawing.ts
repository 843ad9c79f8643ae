// Drawing of missed people: first the feet, then the head.
import type { Point } from '../types';

const kLeastPx = 2; // from feet to head

export class PeopleDrawing {
  /** The points so far while the user is drawing, otherwise null. */
  points: Point[] | null = null;

  constructor(
    private readonly hint: (text: string) => void,
    private readonly warn: (text: string) => void,
    private readonly finished: (foot: Point, head: Point) => void,
    private readonly changed: () => void,
  ) {}

  toggle(): void {
    this.points = this.points ? null : [];
    this.notify();
  }

  /** Discards the current points silently. Drawing mode stays on. */
  clear(): void {
    if (this.points) this.points = [];
  }

  stop(): void {
    this.points = null;
  }

  add(p: Point): void {
    if (!this.points) return;
    this.points.push(p);
    if (this.points.length === 2) {
      const [foot, head] = this.points;
      this.points = [];
      if (head[1] >= foot[1] - kLeastPx) this.warn('Click the feet first, then the head above the feet');
      else this.finished(foot, head);
    }
    this.notify();
  }

  removeLastPoint(): void {
    this.points?.pop();
    this.notify();
  }

  private notify(): void {
    if (this.points) this.hint(this.points.length === 0 ? 'Missed person: click the feet' : 'Click the head');
    else this.hint('');
    this.changed();
  }
}
