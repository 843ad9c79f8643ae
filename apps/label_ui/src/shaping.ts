// Moving, turning and sizing what is selected: shown at once, stored when the keys rest.
import { boxOf, cornersOf } from './geometry';
import { OpenShapes } from './open_shapes';
import type { Store } from './store';
import type { Box, Fields, Label, Point } from './types';

type Shape = Box | { corners: Point[] };

export class Shaping {
  private readonly open: OpenShapes<Shape>;

  constructor(
    private readonly store: Store,
    change: (label: Label, fields: Fields, version: number) => Promise<Label | null>,
  ) {
    this.open = new OpenShapes<Shape>(change, (told) => this.show(told));
    store.onTop = (label) => this.onTop(label);
  }

  /** Shows the shape at once and stores it when the keys have been quiet for a moment. */
  reshape(made: Box | Point[]): void {
    const shape = Array.isArray(made) ? { corners: made } : made;
    const hypothesis = this.store.selectedHypothesis();
    if (hypothesis && !('corners' in shape)) {
      this.store.hypotheses.set(hypothesis.index, { ...hypothesis, ...shape });
      this.store.tell('hypotheses');
      return;
    }
    const label = this.store.selectedLabel();
    if (!label) return;
    const told = this.open.told(label.id) ?? label;
    this.open.begin(told, shape, boxOf(label) ?? { corners: label.corners });
    this.show(withShape(told, shape));
  }

  /** Stores what was reshaped now. */
  flush(): void {
    this.open.flush();
  }

  private show(label: Label): void {
    this.store.labels.set(label.id, label);
    this.store.tell('labels');
  }

  private onTop(label: Label): Label {
    this.open.tell(label);
    const shape = this.open.of(label.id);
    return shape === undefined ? label : withShape(label, shape);
  }
}

function withShape(label: Label, shape: Shape): Label {
  return { ...label, ...shape, corners: 'corners' in shape ? shape.corners : cornersOf(shape) };
}
