// What keys make of things that are asked about: nothing is stored before the answer, so that the page
// alone keeps it, and takes it back as a step each time the keys rest.
import { kQuietMs } from './open_shapes';

export interface Nudge<Shape> {
  name: string;
  before: Shape;
  now: Shape;
}

export class Nudges<Shape> {
  private readonly shapes = new Map<string, Shape>();
  private open: (Nudge<Shape> & { timer: number }) | null = null;

  /** `rested`: hears what keys have made of one. */
  constructor(private readonly rested: (nudge: Nudge<Shape>) => void) {}

  /** As keys have left it, where they have. */
  of(name: string): Shape | undefined {
    return this.shapes.get(name);
  }

  /** As a step has it. */
  put(name: string, shape: Shape): void {
    this.shapes.set(name, shape);
  }

  /** Keys make `now` of it, which was as `before`. */
  begin(name: string, before: Shape, now: Shape): void {
    if (this.open?.name !== name) this.flush();
    window.clearTimeout(this.open?.timer);
    const timer = window.setTimeout(() => this.flush(), kQuietMs);
    this.open = { name, before: this.open?.before ?? before, now, timer };
    this.shapes.set(name, now);
  }

  /** The keys rest. */
  flush(): void {
    const { open } = this;
    if (!open) return;
    window.clearTimeout(open.timer);
    this.open = null;
    this.rested(open);
  }
}
