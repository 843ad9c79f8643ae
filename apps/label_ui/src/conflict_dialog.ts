// Somebody else was first: both versions side by side, and which one shall stand.
import type { Store } from './store';
import type { ClassList, Draft, Label, LabelClass } from './types';
import type { Told, Work } from './work';

const byId = <T extends HTMLElement>(id: string): T => document.getElementById(id) as T;
const kTitle = { label: 'Somebody else changed this label', classes: 'Somebody else changed the classes' };

export class ConflictDialog {
  private readonly dialog = byId<HTMLDialogElement>('conflict');
  private readonly table = document.createElement('table');
  private keepTheirs = (): void => {};
  private useMine = (): void => {};

  constructor(
    private readonly store: Store,
    private readonly work: Work,
    private readonly told: Told,
  ) {
    byId('conflict-table').replaceChildren(this.table);
    byId('conflict-theirs').addEventListener('click', () => this.close(this.keepTheirs));
    byId('conflict-mine').addEventListener('click', () => this.close(this.useMine));
  }

  label(current: Label, yours: Draft & { version: number }): void {
    const deletes = yours.kind === undefined;
    this.begin('label', `label ${current.id}`, `${current.who}, version ${current.version}`, yours.version);
    this.row('', current.deleted ? 'deleted' : 'there', deletes ? 'deleted' : 'there');
    if (!deletes) {
      this.row('class', current.kind, yours.kind);
      this.row('note', current.note, yours.note);
      const text = (value: number | undefined, scale = 1): string =>
        value === undefined ? '–' : (value * scale).toFixed(2);
      this.row('x, y [m]', `${text(current.x)}, ${text(current.y)}`, `${text(yours.x)}, ${text(yours.y)}`);
      this.row('length, width [m]', `${text(current.length)}, ${text(current.width)}`, `${text(yours.length)}, ${text(yours.width)}`);
      this.row('heading [°]', text(current.heading, 180 / Math.PI), text(yours.heading, 180 / Math.PI));
    }
    this.keepTheirs = () => this.store.select({ type: 'label', id: current.id });
    this.useMine = () => {
      if (!deletes) return void this.work.change(current, yours, current.version);
      this.store.select({ type: 'label', id: current.id });
      void this.work.removeSelected();
    };
    this.open();
  }

  classes(current: ClassList, yours: ClassList): void {
    this.begin('classes', 'class', `${current.who}, version ${current.version}`, yours.version);
    const words = (c?: LabelClass): string => (c ? `${c.title}, ${c.colour.toLowerCase()}, ${c.shape}` : 'not there');
    const named = (list: ClassList, kind: string): LabelClass | undefined => list.classes.find((c) => c.kind === kind);
    const kinds = new Set([...current.classes, ...yours.classes].map((c) => c.kind));
    for (const kind of kinds) this.row(kind, words(named(current, kind)), words(named(yours, kind)));
    this.keepTheirs = () => {};
    this.useMine = () => void this.work
      .setClasses(yours.classes, current.version)
      .then((fault) => fault && this.told.warn(fault));
    this.open();
  }

  private begin(about: keyof typeof kTitle, name: string, theirs: string, version: number): void {
    byId('conflict-title').textContent = kTitle[about];
    this.table.replaceChildren();
    this.row(name, theirs, `yours, from version ${version}`, true);
  }

  private row(name: string, theirs: string, mine: string, head = false): void {
    const tr = this.table.insertRow();
    tr.className = !head && theirs !== mine ? 'other' : '';
    for (const text of [name, theirs, mine]) {
      const cell = document.createElement(head ? 'th' : 'td');
      cell.textContent = text;
      tr.append(cell);
    }
  }

  private open(): void {
    if (!this.dialog.open) this.dialog.showModal();
  }

  private close(then: () => void): void {
    this.dialog.close();
    then();
  }
}
