// The buttons of the classes, the panel of the selected object, and the progress.
import { boxOf } from '../ground/geometry';
import { swatch } from './list';
import type { Store } from '../store';
import type { Work } from '../work';
import { isRejected, needsCheck, type Draft, type Fields, type Further, type Label, type Round } from '../types';

const byId = <T extends HTMLElement>(id: string): T => document.getElementById(id) as T;
const degrees = (radians: number): number => (radians * 180) / Math.PI;

export function classButtons(store: Store): void {
  const field = byId<HTMLFieldSetElement>('classes');
  const fill = (): void => fillClasses(field, store);
  fill();
  store.on('classes', fill);
  store.on('class', () => {
    for (const input of field.querySelectorAll('input')) input.checked = input.value === store.kind;
  });
}

function fillClasses(field: HTMLFieldSetElement, store: Store): void {
  for (const old of field.querySelectorAll('label')) old.remove();
  store.classes.forEach((c, i) => {
    const label = document.createElement('label');
    const input = document.createElement('input');
    input.type = 'radio';
    input.name = 'class';
    input.value = c.kind;
    input.className = 'hidden';
    input.checked = c.kind === store.kind;
    input.addEventListener('change', () => {
      store.kind = c.kind;
      store.notify('class');
    });
    label.append(input, swatch(c.colour), c.title);
    if (i < 9) label.append(Object.assign(document.createElement('kbd'), { textContent: String(i + 1) }));
    field.append(label);
  });
}

export class SubjectPanel {
  /** The label that the fields show. */
  private label: Label | null = null;

  constructor(
    private readonly store: Store,
    private readonly work: Work,
  ) {
    const kinds = byId<HTMLSelectElement>('label-kind');
    const fillKinds = (): void =>
      kinds.replaceChildren(...store.classes.map((c) => new Option(c.title, c.kind)));
    fillKinds();
    store.on('classes', () => {
      fillKinds();
      this.show();
    });
    kinds.addEventListener('change', () => this.set({ kind: kinds.value }));
    const note = byId<HTMLInputElement>('label-note');
    note.addEventListener('change', () => this.set({ note: note.value }));
    const numbers: [string, (value: number) => Partial<Draft>][] = [
      ['label-length', (length) => ({ length })],
      ['label-width', (width) => ({ width })],
      ['label-heading', (angle) => ({ heading: (angle * Math.PI) / 180 })],
    ];
    for (const [id, fields] of numbers) {
      const input = byId<HTMLInputElement>(id);
      input.addEventListener('change', () => {
        if (input.checkValidity()) this.set(fields(input.valueAsNumber));
        else input.reportValidity();
      });
    }
    // A user who edits a field is working on the label. No question may replace the label.
    const properties = byId<HTMLFormElement>('properties');
    properties.addEventListener('focusin', () => work.questions.setUserEditing());
    properties.addEventListener('focusout', ({ relatedTarget }) => {
      if (!store.selectedLabel() && !properties.contains(relatedTarget as Node | null)) this.show();
    });
    properties.addEventListener('submit', (event) => event.preventDefault());
    const press = (id: string, action: () => void): void =>
      byId(id).addEventListener('click', action);
    press('accept', () => this.work.answer(true));
    press('reject', () => this.work.answer(false));
    press('skip', () => this.work.skip());
    press('all', () => void this.work.likely.acceptInView());
    press('delete', () => void this.work.removeSelected());
    for (const topic of ['selection', 'labels', 'hypotheses'] as const)
      store.on(topic, () => this.show());
  }

  private set(fields: Fields): void {
    const label = this.store.selectedLabel();
    if (label) return void this.work.setFields(label, fields);
    if (!this.label) return;
    void this.work.setFields(this.label, fields); // a conflict, in which the user decides between the versions
    this.label = null; // once
    this.show();
  }

  // The label whose field the user is editing, although another user has deleted it. The page keeps
  // the typed text.
  private deleted(): Label | null {
    const { selection } = this.store;
    if (selection.type !== 'label' || selection.id !== this.label?.id) return null;
    return byId('properties').contains(document.activeElement) ? this.label : null;
  }

  private show(): void {
    const hypothesis = this.store.selectedHypothesis();
    const label = this.store.selectedLabel();
    const deleted = label ? null : this.deleted();
    this.label = label ?? deleted;
    const look = label !== null && needsCheck(label);
    byId<HTMLButtonElement>('accept').disabled = hypothesis === null && !look;
    for (const id of ['reject', 'skip'])
      byId<HTMLButtonElement>(id).disabled = hypothesis === null;
    byId<HTMLButtonElement>('all').disabled = this.store.likely().length === 0;
    byId<HTMLButtonElement>('delete').disabled = label === null;
    byId('properties').hidden = this.label === null || isRejected(this.label);
    showFurther(byId('further'), label?.further);
    if (hypothesis) {
      const left = this.store.openQuestions().length;
      const { title } = this.store.classOf(hypothesis.kind);
      this.title(`Is this a ${title}?`);
      this.text(
        `detector: ${Math.round(100 * hypothesis.calibrated)} %; ` +
          `${left} open questions in this round`,
      );
    } else if (label) {
      const { title } = this.store.classOf(label.kind);
      this.title(`${isRejected(label) ? 'No ' : ''}${title} ${label.id}`);
      const place = label.sigma_m === undefined ? '' : `, place ± ${(100 * label.sigma_m).toFixed(0)} cm`;
      this.text(`${label.source} by ${label.who}, ${label.when.slice(0, 16).replace('T', ' ')}${place}, version ${label.version}`);
      if (look && label.gone)
        this.text(
          `The images of ${label.gone} do not show its paint. ` +
            'Delete it, or accept it (a) if it is still right',
        );
      else if (look)
        this.text(
          `Moved ${(100 * label.moved_m!).toFixed(0)} cm with the map, farther than expected. ` +
            'Correct it, or accept it (a) if it is right',
        );
      this.fill(label);
    } else if (deleted) {
      this.title(`${this.store.classOf(deleted.kind).title} ${deleted.id} was deleted`);
      this.text(`Deleted by ${this.store.labels.get(deleted.id)?.who ?? 'another user'}. You can finish typing: then the page asks which version to keep`);
    } else {
      this.title('Nothing selected');
      this.text('d: draw; t: train; n: next question');
    }
  }

  private title(text: string): void {
    byId('subject').textContent = text;
  }

  private text(text: string): void {
    byId('subject-text').textContent = text;
  }

  private fill(label: Label): void {
    const set = (id: string, value: string): void => {
      const input = byId<HTMLInputElement>(id);
      if (document.activeElement !== input) input.value = value;
    };
    const box = boxOf(label);
    for (const id of ['label-length', 'label-width', 'label-heading'])
      byId<HTMLInputElement>(id).disabled = box === null;
    set('label-kind', label.kind);
    set('label-note', label.note);
    set('label-length', box ? box.length.toFixed(2) : '');
    set('label-width', box ? box.width.toFixed(2) : '');
    set('label-heading', box ? degrees(box.heading).toFixed(1) : '');
  }
}

function showFurther(line: HTMLElement, further: Further | undefined): void {
  line.hidden = further === undefined;
  if (!further) return;
  const { images, apart_m, sigmas, contradicts } = further;
  const cm = (m: number): string => `${(100 * m).toFixed(0)} cm`;
  const where = images.map((image) => `${image.session}, ${image.camera}, ${cm(image.apart_m)}`);
  const sure = `${sigmas.toFixed(1)} standard deviations`;
  const found =
    images.length === 1
      ? `Also found in another image: ${where[0]} from here (${sure}). `
      : `Also found in ${images.length} other images, ${cm(apart_m)} from here (root mean square; ${sure}): ${where.join('; ')}. `;
  line.textContent =
    found +
    (contradicts ? 'The distance is larger than the poses allow: the map is distorted here, or it is another object.' : 'The distance agrees with the poses.');
  line.classList.toggle('bad', contradicts);
}

export class ProgressPanel {
  constructor(private readonly store: Store) {
    store.on('progress', () => this.show());
    store.on('labels', () => this.show());
    store.on('hypotheses', () => this.show());
  }

  private show(): void {
    const { rounds, running, accepted = 0, rejected = 0 } = this.store.progress;
    const list = document.createElement('dl');
    const add = (name: string, value: string, className = ''): void => {
      const dt = document.createElement('dt');
      dt.textContent = name;
      const dd = document.createElement('dd');
      dd.textContent = value;
      dd.className = className;
      list.append(dt, dd);
    };
    const labels = this.store.active().filter((label) => !isRejected(label));
    const drawn = labels.filter((label) => label.source === 'drawn').length;
    add('labels', `${labels.length}, ${drawn} drawn`);
    const look = labels.filter(needsCheck);
    const gone = look.filter((label) => label.gone).length;
    const why = [[look.length - gone, 'moved farther than expected'], [gone, 'with missing paint']] as const;
    if (look.length > 0) add('to check', why.filter(([n]) => n > 0).map(([n, text]) => `${n} ${text}`).join(', '));
    const likely = this.store.likely().length;
    if (this.store.round > 0)
      add('open', `${likely} likely hypotheses, ${this.store.openQuestions().length} questions`);
    const answered = accepted + rejected;
    if (answered > 0)
      add('precision so far', `${((100 * accepted) / answered).toFixed(0)} % (${accepted} of ${answered} likely hypotheses right)`);
    const last = rounds[rounds.length - 1];
    if (running) add('round', 'training …', 'running');
    if (last) add(`round ${last.round}`, roundText(last));
    document.getElementById('progress')!.replaceChildren(list);
  }
}

function roundText(round: Round): string {
  const from = `${round.positives} positive and ${round.negatives} negative examples`;
  const gone = round.gone > 0 ? `, ${round.gone} no longer found` : '';
  return `${from}: ${round.found} likely, ${round.fresh} new${gone} (${round.seconds.toFixed(1)} s)`;
}
