// The shapes that keys have given to hypotheses with open questions. The server stores nothing
// before the answer. The page alone keeps the shapes, and makes an undo step each time no key is
// pressed for a while.
import { kQuietMs } from './open_shapes';

export interface Nudge<Shape> {
  name: string;
  before: Shape;
  now: Shape;
}

export class Nudges<Shape> {
  private readonly shapes = new Map<string, Shape>();
  private open: (Nudge<Shape> & { timer: number }) | null = null;

  /** `rested` receives the change of a hypothesis when no key is pressed for a while. */
  constructor(private readonly onPause: (nudge: Nudge<Shape>) => void) {}

  /** Returns the shape that keys have given it, if any. */
  of(name: string): Shape | undefined {
    return this.shapes.get(name);
  }

  /** Sets the shape of an undo or redo step. */
  set(name: string, shape: Shape): void {
    this.shapes.set(name, shape);
  }

  /** Keys have changed a hypothesis from `before` to `now`. */
  change(name: string, before: Shape, now: Shape): void {
    if (this.open?.name !== name) this.flush();
    window.clearTimeout(this.open?.timer);
    const timer = window.setTimeout(() => this.flush(), kQuietMs);
    this.open = { name, before: this.open?.before ?? before, now, timer };
    this.shapes.set(name, now);
  }

  /** Ends the current change and reports it. */
  flush(): void {
    const { open } = this;
    if (!open) return;
    window.clearTimeout(open.timer);
    this.open = null;
    this.onPause(open);
  }
}
