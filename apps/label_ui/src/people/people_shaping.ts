// Moves and resizes a window of an image. The page shows each change at once and stores it when no
// key is pressed for a while.
import { OpenShapes } from '../sync/open_shapes';
import type { Fields, Label, Point, Standing, Upright } from '../types';

const kLeastPx = 4; // from feet to head

const moved = (p: Point, dx: number, dy: number): Point => [p[0] + dx, p[1] + dy];

/** Moves feet and head by the given number of pixels. Empty if the head would be below the feet. */
export function reshaped(old: Upright, foot: Point, head: Point): Upright | null {
  const shape: Upright = {
    foot: moved(old.foot, foot[0], foot[1]),
    head: moved(old.head, head[0], head[1]),
    // An approximation, until the server returns the outline that the fisheye lens bends.
    outline: old.outline.map((p) => {
      const part = (p[1] - old.foot[1]) / (old.head[1] - old.foot[1] || 1);
      return moved(p, foot[0] + part * (head[0] - foot[0]), foot[1] + part * (head[1] - foot[1]));
    }),
  };
  return shape.head[1] < shape.foot[1] - kLeastPx ? shape : null;
}

export class WindowShaping {
  private readonly open: OpenShapes<Upright>;

  constructor(
    change: (label: Label, fields: Fields, from: Standing) => Promise<Label | null>,
    private readonly changed: () => void,
  ) {
    this.open = new OpenShapes<Upright>(
      (label, { foot, head }, from) => change(label, { foot, head }, from),
      changed,
    );
  }

  /** Returns the label as displayed, with the shape that the keys have given it. */
  shown(label: Label): Label {
    const shape = this.open.of(label.id);
    return shape ? { ...label, ...shape } : label;
  }

  begin(label: Label, shape: Upright): void {
    this.open.change(label, shape, this.shown(label) as Upright);
    this.changed();
  }

  /** Stores the changed shape now. */
  flush(): void {
    this.open.flush();
  }
}
