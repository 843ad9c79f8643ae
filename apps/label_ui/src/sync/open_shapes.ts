// Shapes that the user has changed with keys and that the server has not confirmed yet. The page
// shows them at once and sends them when no key is pressed for a while. They replace the shapes
// that arrive from the server in the meantime.
import type { Label, Standing } from '../types';

export const kQuietMs = 350; // pause between keys after which a change is stored

interface Open<Shape> {
  received: Label; // as last received from the server
  from: Standing; // the version on which the next change is based, without others' changes
  shape: Shape;
  base: Shape; // the shape last sent, or the shape before the first key
  timer: number | undefined; // until the shape is sent
  sent: number; // changes without an answer
}

/**
 * Returns the fields of a shape that differ from before. The changes of other users to the other
 * fields stay.
 */
export function changedFields<Shape extends object>(before: Shape, now: Shape): Partial<Shape> {
  const was = new Map(Object.entries(before));
  const differ = ([name, value]: [string, unknown]): boolean => JSON.stringify(value) !== JSON.stringify(was.get(name));
  return Object.fromEntries(Object.entries(now).filter(differ)) as Partial<Shape>;
}

export class OpenShapes<Shape extends object> {
  private readonly open = new Map<number, Open<Shape>>();

  /**
   * `send` stores the new fields of a shape and returns null if this fails. `closed` is called when
   * the page shows a label in the server's shape again.
   */
  constructor(
    private readonly send: (label: Label, changed: Partial<Shape>, from: Standing) => Promise<Label | null>,
    private readonly closed: (label: Label) => void,
  ) {}

  of(id: number): Shape | undefined {
    return this.open.get(id)?.shape;
  }

  /** Returns a label without its open shape. */
  receivedLabel(id: number): Label | undefined {
    return this.open.get(id)?.received;
  }

  /** Takes the state of a label that arrives from the server in the meantime. */
  receive(label: Label): void {
    const open = this.open.get(label.id);
    if (open) open.received = label;
  }

  /** Keys have changed `base` to this shape. Sends the open shapes of other labels. */
  change(received: Label, shape: Shape, base: Shape): void {
    for (const [id, other] of this.open) if (id !== received.id) this.flushOne(id, other);
    const before = this.open.get(received.id);
    window.clearTimeout(before?.timer);
    const open = before ?? { received: received, from: received, shape, base, timer: undefined, sent: 0 };
    Object.assign(open, { received, shape });
    open.timer = window.setTimeout(() => this.flushOne(received.id, open), kQuietMs);
    this.open.set(received.id, open);
  }

  /** Sends all open shapes now. */
  flush(): void {
    for (const [id, open] of this.open) this.flushOne(id, open);
  }

  private flushOne(id: number, open: Open<Shape>): void {
    if (open.timer === undefined) return;
    window.clearTimeout(open.timer);
    open.timer = undefined;
    ++open.sent;
    const changed = changedFields(open.base, open.shape);
    open.base = open.shape;
    void this.send(open.received, changed, open.from).then((stored) => {
      --open.sent;
      if (stored) open.from = stored;
      if (open.timer !== undefined || open.sent > 0) return; // more keys were pressed in the meantime
      this.open.delete(id);
      this.closed(open.received);
    });
  }
}
