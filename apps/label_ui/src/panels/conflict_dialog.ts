// Another user has changed the label first. The dialog shows both versions side by side and asks
// which version to keep.
import type { Store } from '../store';
import { isOnGround, type ClassList, type Fields, type Label, type LabelClass, type Standing } from '../types';
import type { ClassConflict, LabelConflict } from '../sync/server';
import type { Notifier, Work } from '../work';

const byId = <T extends HTMLElement>(id: string): T => document.getElementById(id) as T;
const kTitle = { label: 'Another user changed this label', classes: 'Another user changed the classes' };

export class ConflictDialog {
  private readonly dialog = byId<HTMLDialogElement>('conflict');
  private readonly table = document.createElement('table');
  private turn: Promise<void> = Promise.resolve();
  private answered = { name: '', mine: false };

  constructor(
    private readonly store: Store,
    private readonly work: Work,
    private readonly notifier: Notifier,
  ) {
    byId('conflict-table').replaceChildren(this.table);
    byId('conflict-theirs').addEventListener('click', () => this.dialog.close(''));
    byId('conflict-mine').addEventListener('click', () => this.dialog.close('mine'));
  }

  show(conflict: LabelConflict | ClassConflict): void {
    if (conflict.about === 'label') this.askAboutLabel(conflict);
    else this.askAboutClasses(conflict);
  }

  private askAboutLabel({ current: stored, yours, deletes, request }: LabelConflict): void {
    this.ask(`${deletes} ${stored.id} ${yours.version}`, request, () => {
      const known = this.store.labels.get(stored.id);
      const current = known && known.version > stored.version ? known : stored;
      this.showLabel(current, { ...current, ...yours }, deletes);
      return async (mine) => {
        if (!mine && isOnGround(current)) this.store.select({ type: 'label', id: current.id });
        if (mine && !deletes) await this.work.change(current, yours, current);
        if (mine && deletes && (await this.work.remove(current))) await this.work.loadHypotheses();
      };
    });
  }

  private askAboutClasses({ current: stored, yours, request }: ClassConflict): void {
    this.ask(`classes ${yours.version}`, request, () => {
      this.showClasses(stored, yours);
      return async (mine) => {
        const fault = mine ? await this.work.setClasses(yours.classes, stored) : '';
        if (fault) this.notifier.warn(fault);
      };
    });
  }

  // Shows the conflicts one after another, each with the current version. One answer applies to all
  // changes that were made on the same version. `show` fills the dialog and returns the function
  // that carries out the answer.
  private ask(name: string, request: string, show: () => (mine: boolean) => Promise<void>): void {
    const one = async (): Promise<void> => {
      const then = show();
      if (name !== this.answered.name) this.answered = { name, mine: await this.answer() };
      const done = then(this.answered.mine);
      this.work.resolveConflict(request); // the replacement is stored in the browser now
      await done;
    };
    this.turn = this.turn.then(one, one);
  }

  private async answer(): Promise<boolean> {
    this.dialog.returnValue = '';
    this.dialog.showModal();
    await new Promise((closed) => this.dialog.addEventListener('close', closed, { once: true }));
    return this.dialog.returnValue === 'mine';
  }

  private showLabel(current: Label, yours: Fields & Standing, deletes: boolean): void {
    this.begin('label', `label ${current.id}`, `${current.who}, version ${current.version}`, yours.version);
    this.row('state', current.deleted ? 'deleted' : 'exists', deletes ? 'deleted' : 'exists');
    if (deletes) return;
    this.row('class', current.kind, yours.kind ?? '');
    this.row('note', current.note, yours.note ?? '');
    const text = (value: number | undefined, scale = 1): string =>
      value === undefined ? '–' : (value * scale).toFixed(2);
    this.row('x, y [m]', `${text(current.x)}, ${text(current.y)}`, `${text(yours.x)}, ${text(yours.y)}`);
    this.row('length, width [m]', `${text(current.length)}, ${text(current.width)}`, `${text(yours.length)}, ${text(yours.width)}`);
    this.row('heading [°]', text(current.heading, 180 / Math.PI), text(yours.heading, 180 / Math.PI));
  }

  private showClasses(current: ClassList, yours: ClassList): void {
    this.begin('classes', 'class', `${current.who}, version ${current.version}`, yours.version);
    const words = (c?: LabelClass): string => (c ? `${c.title}, ${c.colour.toLowerCase()}, ${c.shape}` : 'not in the list');
    const named = (list: ClassList, kind: string): LabelClass | undefined => list.classes.find((c) => c.kind === kind);
    const kinds = new Set([...current.classes, ...yours.classes].map((c) => c.kind));
    for (const kind of kinds) this.row(kind, words(named(current, kind)), words(named(yours, kind)));
  }

  private begin(about: keyof typeof kTitle, name: string, theirs: string, version: number): void {
    byId('conflict-title').textContent = kTitle[about];
    this.table.replaceChildren();
    this.row(name, theirs, `you, based on version ${version}`, true);
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
}
