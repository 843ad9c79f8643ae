// Shapes that keys have left and the server has not answered for yet: shown at once, sent when the
// keys rest, and shown on top of whatever the server tells of those labels meanwhile.
import type { Label } from './types';

const kQuietMs = 350; // of keys, after which a change is stored

interface Open<Shape> {
  told: Label; // as the server last told
  version: number; // what the next change begins from: not what others made meanwhile
  shape: Shape;
  timer: number | undefined; // until the shape is sent
  sent: number; // changes without an answer
}

export class OpenShapes<Shape> {
  private readonly open = new Map<number, Open<Shape>>();

  /** `send`: stores a shape, null where that failed. `closed`: a label is again as it was told. */
  constructor(
    private readonly send: (told: Label, shape: Shape, version: number) => Promise<Label | null>,
    private readonly closed: (told: Label) => void,
  ) {}

  of(id: number): Shape | undefined {
    return this.open.get(id)?.shape;
  }

  /** A label without its open shape, where it has one. */
  told(id: number): Label | undefined {
    return this.open.get(id)?.told;
  }

  /** What the server says of a label meanwhile. */
  tell(label: Label): void {
    const open = this.open.get(label.id);
    if (open) open.told = label;
  }

  /** Keys have left this shape; those of other labels are sent. */
  begin(told: Label, shape: Shape): void {
    for (const [id, other] of this.open) if (id !== told.id) this.flushOne(id, other);
    const before = this.open.get(told.id);
    window.clearTimeout(before?.timer);
    const open = before ?? { told, version: told.version, shape, timer: undefined, sent: 0 };
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
    void this.send(open.told, open.shape, open.version).then((stored) => {
      --open.sent;
      if (stored) open.version = stored.version;
      if (open.timer !== undefined || open.sent > 0) return; // keys went on meanwhile
      this.open.delete(id);
      this.closed(open.told);
    });
  }
}
