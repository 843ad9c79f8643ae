// Moving, turning and sizing what is selected: shown at once, stored when the keys rest.
import { boxOf, cornersOf } from './geometry';
import type { Store } from './store';
import type { Box, Draft, Label, Point } from './types';

const kQuietMs = 350; // of keys, after which a change is stored

export class Shaping {
  private edit: { original: Label; timer: number } | null = null;

  constructor(
    private readonly store: Store,
    private readonly change: (label: Label, draft: Draft) => Promise<Label | null>,
  ) {}

  /** Shows the shape at once and stores it when the keys have been quiet for a moment. */
  reshape(shape: Box | Point[]): void {
    const hypothesis = this.store.selectedHypothesis();
    if (hypothesis && !Array.isArray(shape)) {
      this.store.hypotheses.set(hypothesis.index, { ...hypothesis, ...shape });
      this.store.tell('hypotheses');
      return;
    }
    const label = this.store.selectedLabel();
    if (!label) return;
    if (this.edit && this.edit.original.id !== label.id) this.flush();
    const original = this.edit?.original ?? label;
    window.clearTimeout(this.edit?.timer);
    this.edit = { original, timer: window.setTimeout(() => this.flush(), kQuietMs) };
    this.store.labels.set(label.id, withShape(label, shape));
    this.store.tell('labels');
  }

  /** Stores what was reshaped now. */
  flush(): void {
    if (!this.edit) return;
    const { original, timer } = this.edit;
    window.clearTimeout(timer);
    this.edit = null;
    const now = this.store.labels.get(original.id);
    if (!now || now.version !== original.version) return;
    void this.change(original, draftOf(now)).then((stored) => {
      if (!stored && this.store.labels.get(original.id) === now) {
        this.store.labels.set(original.id, original);
        this.store.tell('labels');
      }
    });
  }
}

export function draftOf(label: Label): Draft {
  const { kind, source, score, note, shape } = label;
  const box = boxOf(label);
  return { kind, source, score, note, shape, ...(box ?? { corners: label.corners }) };
}

function withShape(label: Label, shape: Box | Point[]): Label {
  return Array.isArray(shape)
    ? { ...label, corners: shape }
    : { ...label, ...shape, corners: cornersOf(shape) };
}

