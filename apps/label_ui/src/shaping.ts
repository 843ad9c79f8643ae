// Moving, turning and sizing what is selected: shown at once, stored when the keys rest.
import { boxOf, cornersOf } from './geometry';
import { OpenShapes } from './open_shapes';
import type { Store } from './store';
import type { Box, Draft, Label, Point } from './types';

type Shape = Box | Point[];

export class Shaping {
  private readonly open: OpenShapes<Shape>;

  constructor(
    private readonly store: Store,
    change: (label: Label, draft: Draft, version: number) => Promise<Label | null>,
  ) {
    this.open = new OpenShapes<Shape>(
      (told, shape, version) => change(told, draftOf(withShape(told, shape)), version),
      (told) => this.show(told),
    );
    store.onTop = (label) => this.onTop(label);
  }

  /** Shows the shape at once and stores it when the keys have been quiet for a moment. */
  reshape(shape: Shape): void {
    const hypothesis = this.store.selectedHypothesis();
    if (hypothesis && !Array.isArray(shape)) {
      this.store.hypotheses.set(hypothesis.index, { ...hypothesis, ...shape });
      this.store.tell('hypotheses');
      return;
    }
    const label = this.store.selectedLabel();
    if (!label) return;
    const told = this.open.told(label.id) ?? label;
    this.open.begin(told, shape);
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

export function draftOf(label: Label): Draft {
  const { kind, source, score, note, shape } = label;
  const box = boxOf(label);
  return { kind, source, score, note, shape, ...(box ?? { corners: label.corners }) };
}

function withShape(label: Label, shape: Shape): Label {
  return Array.isArray(shape)
    ? { ...label, corners: shape }
    : { ...label, ...shape, corners: cornersOf(shape) };
}
