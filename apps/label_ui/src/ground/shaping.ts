// Moves, turns and resizes the selected object. The page shows each change at once and stores it
// when no key is pressed for a while.
import { boxFields, boxOf, cornersOf } from './geometry';
import { Nudges } from '../sync/nudges';
import { OpenShapes } from '../sync/open_shapes';
import type { Store } from '../store';
import type { Box, Fields, Label, Point, Standing } from '../types';

type Shape = Box | { corners: Point[] };

export class Shaping {
  private readonly open: OpenShapes<Shape>;
  private readonly nudges: Nudges<Box>;

  /**
   * `nudged` is called when the user has moved a hypothesis with keys. `before` is its earlier
   * shape, and `put` shows it in another shape.
   */
  constructor(
    private readonly store: Store,
    change: (label: Label, fields: Fields, from: Standing) => Promise<Label | null>,
    nudged: (index: number, before: Box, now: Box, put: (index: number, box: Box) => void) => void,
  ) {
    this.open = new OpenShapes<Shape>(change, (received) => this.show(received));
    const put = (index: number, box: Box): void => {
      this.nudges.set(String(index), box);
      this.showNudged(index, box);
    };
    this.nudges = new Nudges<Box>(({ name, before, now }) => nudged(Number(name), before, now, put));
    store.withUnsavedShape = (label) => this.withUnsavedShape(label);
    store.withMovedShape = (h) => ({ ...h, ...this.nudges.of(String(h.index)) });
  }

  /** Shows the shape at once. Stores it when no key is pressed for a moment. */
  reshape(made: Box | Point[]): void {
    const shape = Array.isArray(made) ? { corners: made } : made;
    const hypothesis = this.store.selectedHypothesis();
    if (hypothesis && !('corners' in shape)) {
      const { index } = hypothesis;
      this.nudges.change(String(index), boxFields(hypothesis), boxFields(shape));
      return this.showNudged(index, boxFields(shape));
    }
    const label = this.store.selectedLabel();
    if (!label) return;
    const received = this.open.receivedLabel(label.id) ?? label;
    this.open.change(received, shape, boxOf(label) ?? { corners: label.corners });
    this.show(withShape(received, shape));
  }

  /** Stores the changed shapes now. */
  flush(): void {
    this.open.flush();
    this.nudges.flush();
  }

  private showNudged(index: number, box: Box): void {
    const hypothesis = this.store.hypotheses.get(index);
    if (!hypothesis) return;
    this.store.hypotheses.set(index, { ...hypothesis, ...box });
    this.store.notify('hypotheses');
  }

  private show(label: Label): void {
    this.store.labels.set(label.id, label);
    this.store.notify('labels');
  }

  private withUnsavedShape(label: Label): Label {
    this.open.receive(label);
    const shape = this.open.of(label.id);
    return shape === undefined ? label : withShape(label, shape);
  }
}

function withShape(label: Label, shape: Shape): Label {
  return { ...label, ...shape, corners: 'corners' in shape ? shape.corners : cornersOf(shape) };
}
