// Shapes that the user has changed with keys and that the server has not confirmed yet. The page
// shows them at once and sends them when no key is pressed for a while. They replace the shapes
// that arrive from the server in the meantime.
import type { Label, Standing } from '../types';

export const kQuietMs = 350; // of keys, after which a change is stored

interface Open<Shape> {
  told: Label; // as last received from the server
  from: Standing; // the version on which the next change is based, without others' changes
  shape: Shape;
  base: Shape; // the last one sent, or what keys began from
  timer: number | undefined; // until the shape is sent
  sent: number; // changes without an answer
}

/** Those fields of a shape that are not as before: what others made of the rest meanwhile stays. */
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
    private readonly send: (told: Label, changed: Partial<Shape>, from: Standing) => Promise<Label | null>,
    private readonly closed: (told: Label) => void,
  ) {}

  of(id: number): Shape | undefined {
    return this.open.get(id)?.shape;
  }

  /** A label without its open shape, where it has one. */
  told(id: number): Label | undefined {
    return this.open.get(id)?.told;
  }

  /** Takes the state of a label that arrives from the server in the meantime. */
  tell(label: Label): void {
    const open = this.open.get(label.id);
    if (open) open.told = label;
  }

  /** Keys have left this shape of what was `base`; those of other labels are sent. */
  begin(told: Label, shape: Shape, base: Shape): void {
    for (const [id, other] of this.open) if (id !== told.id) this.flushOne(id, other);
    const before = this.open.get(told.id);
    window.clearTimeout(before?.timer);
    const open = before ?? { told, from: told, shape, base, timer: undefined, sent: 0 };
    Object.assign(open, { told, shape });
    open.timer = window.setTimeout(() => this.flushOne(told.id, open), kQuietMs);
    this.open.set(told.id, open);
  }

  /** Sends what keys have left now. */
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
    void this.send(open.told, changed, open.from).then((stored) => {
      --open.sent;
      if (stored) open.from = stored;
      if (open.timer !== undefined || open.sent > 0) return; // keys went on meanwhile
      this.open.delete(id);
      this.closed(open.told);
    });
  }
}
