// Classes and colours of the map, edited in a dialog.
import type { Store } from '../store';
import type { LabelClass, Standing } from '../types';
import type { Work } from '../work';

const byId = <T extends HTMLElement>(id: string): T => document.getElementById(id) as T;
// Okabe and Ito 2008.
const kColours = ['#56B4E9', '#E69F00', '#CC79A7', '#009E73', '#F0E442', '#D55E00'];

export class ClassesDialog {
  private readonly dialog = byId<HTMLDialogElement>('classes-dialog');
  private readonly rows = this.dialog.querySelector('tbody')!;

  /** The version of the classes when the dialog was opened. */
  private from: Standing = { version: 0, when: '' };

  constructor(
    private readonly store: Store,
    private readonly work: Work,
  ) {
    byId('edit-classes').addEventListener('click', () => this.open());
    byId('classes-add').addEventListener('click', () => {
      this.add({ kind: '', title: '', colour: kColours[this.rows.rows.length % kColours.length], shape: 'box' }, true);
      this.rows.querySelector<HTMLInputElement>('tr:last-child input')!.focus();
    });
    byId('classes-save').addEventListener('click', () => void this.save());
  }

  private open(): void {
    this.rows.replaceChildren();
    this.fault('');
    for (const c of this.store.classes) this.add(c, false);
    this.from = this.store.classesFrom;
    this.dialog.showModal();
  }

  // The name of an existing class is fixed, because its labels contain it.
  private add(c: LabelClass, isNew: boolean): void {
    const row = this.rows.insertRow();
    const cell = (field: HTMLInputElement | HTMLSelectElement, name: string, value: string): void => {
      field.name = name;
      field.value = value;
      field.setAttribute('aria-label', `${name} of class ${c.kind || this.rows.rows.length}`);
      row.insertCell().append(field);
    };
    const text = (readOnly: boolean): HTMLInputElement =>
      Object.assign(document.createElement('input'), { maxLength: 64, required: true, readOnly, autocomplete: 'off' });
    cell(text(!isNew), 'kind', c.kind);
    cell(text(false), 'title', c.title);
    cell(Object.assign(document.createElement('input'), { type: 'color' }), 'colour', c.colour);
    const shape = document.createElement('select');
    shape.add(new Option('box', 'box'));
    shape.add(new Option('polygon', 'polygon'));
    cell(shape, 'shape', c.shape);
  }

  private async save(): Promise<void> {
    const classes = [...this.rows.rows].map((row) => {
      const value = (name: string): string =>
        row.querySelector<HTMLInputElement | HTMLSelectElement>(`[name=${name}]`)!.value.trim();
      const kind = value('kind').replace(/\s+/g, '_');
      return { kind, title: value('title') || kind, colour: value('colour'), shape: value('shape') };
    });
    const button = byId<HTMLButtonElement>('classes-save');
    button.disabled = true; // prevents a second request while the first one waits for the server
    const fault = await this.work.setClasses(classes.filter((c) => c.kind) as LabelClass[], this.from);
    button.disabled = false;
    this.fault(fault);
    if (!fault) this.dialog.close();
  }

  private fault(text: string): void {
    byId('classes-fault').textContent = text;
  }
}
