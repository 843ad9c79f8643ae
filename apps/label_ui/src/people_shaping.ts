// Moving and sizing a window of an image: shown at once, stored when the keys rest.
import type { Label, Point, Upright, WindowDraft } from './types';

const kQuietMs = 350; // of keys, after which a change is stored
const kLeastPx = 4; // from feet to head

const moved = (p: Point, dx: number, dy: number): Point => [p[0] + dx, p[1] + dy];

/** Feet and head moved by so many pixels; empty where the head would come below the feet. */
export function reshaped(old: Upright, foot: Point, head: Point): Upright | null {
  const shape: Upright = {
    foot: moved(old.foot, foot[0], foot[1]),
    head: moved(old.head, head[0], head[1]),
    // As near as needed until the server says how the fisheye bends it.
    outline: old.outline.map((p) => {
      const part = (p[1] - old.foot[1]) / (old.head[1] - old.foot[1] || 1);
      return moved(p, foot[0] + part * (head[0] - foot[0]), foot[1] + part * (head[1] - foot[1]));
    }),
  };
  return shape.head[1] < shape.foot[1] - kLeastPx ? shape : null;
}

export class WindowShaping {
  private edit: { label: Label; shape: Upright; timer: number } | null = null;

  constructor(
    private readonly change: (label: Label, draft: WindowDraft) => Promise<Label | null>,
    private readonly changed: () => void,
  ) {}

  /** A label as it is shown: as keys have left it. */
  shown(label: Label): Label {
    return this.edit?.label.id === label.id ? { ...label, ...this.edit.shape } : label;
  }

  begin(label: Label, shape: Upright): void {
    window.clearTimeout(this.edit?.timer);
    this.edit = { label, shape, timer: window.setTimeout(() => this.flush(), kQuietMs) };
    this.changed();
  }

  /** Stores what was reshaped now. */
  flush(): void {
    const mine = this.edit;
    if (!mine) return;
    const { label, shape, timer } = mine;
    window.clearTimeout(timer);
    const { kind, source, score, note, anchor } = label;
    const { foot, head } = shape;
    void this.change(label, { ...anchor, kind, source, score, note, shape: 'upright', foot, head }).finally(() => {
      if (this.edit === mine) this.edit = null;
      this.changed();
    });
  }
}
