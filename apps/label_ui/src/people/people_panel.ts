// Shows the open question about people, the windows in the image, and the progress.
import type { PeopleWork } from './people_work';
import type { Store } from '../store';
import { isRejected, type PeopleRound } from '../types';

const byId = <T extends HTMLElement>(id: string): T => document.getElementById(id) as T;
const percent = (part: number): string => `${Math.round(100 * part)} %`;

export class PeoplePanel {
  constructor(
    _store: Store,
    private readonly people: PeopleWork,
  ) {
    const press = (id: string, action: () => void): void => byId(id).addEventListener('click', action);
    press('people-accept', () => people.answer(true));
    press('people-reject', () => people.answer(false));
    press('people-skip', () => people.skip());
    press('people-delete', () => void people.remove());
    press('people-done', () => void people.done());
    press('people-next', () => void people.next());
    press('people-before', () => void people.neighbour(-1));
    press('people-after', () => void people.neighbour(1));
    people.on(() => this.show());
  }

  private show(): void {
    const { people } = this;
    const { image } = people;
    const h = people.hypothesis();
    const label = people.window();
    const enable = (id: string, on: boolean): void => {
      byId<HTMLButtonElement>(id).disabled = !on;
    };
    enable('people-accept', h !== null || (label !== null && isRejected(label)));
    enable('people-reject', h !== null || (label !== null && !isRejected(label)));
    enable('people-skip', h !== null);
    enable('people-delete', label !== null);
    enable('people-done', image !== null);
    enable('people-before', image?.before != null);
    enable('people-after', image?.after != null);
    byId('draw').setAttribute('aria-pressed', String(people.points !== null));
    byId('people-place').textContent = image ? `${image.place}, ${timeOf(image.t_ns)}` : '';
    this.subject();
    this.list();
    this.cameras();
    this.progress();
  }

  private subject(): void {
    const { people } = this;
    const h = people.hypothesis();
    const label = people.window();
    const likely = people.likely().length;
    const left = people.asked.open().filter((one) => !people.asked.isSkipped(one)).length;
    let [title, text] = ['No image', 'n: next image'];
    if (h) {
      title = 'Is this a person?';
      text = `detector: ${percent(h.calibrated)}; ${left} open in this image`;
    } else if (label) {
      title = isRejected(label) ? `No person ${label.id}` : `Person ${label.id}`;
      text = `${label.source} by ${label.who}, ${label.when.slice(0, 16).replace('T', ' ')}, version ${label.version}`;
    } else if (people.image) {
      title = people.isDone() ? 'This image is done' : 'Does the image show another person?';
      text = people.isDone() ? 'n: next image' : 'd: draw a missed person (feet, then head); Enter: no other person';
    }
    byId('people-subject').textContent = title;
    byId('people-text').textContent = text;
    const done = byId('people-done');
    const words = people.isDone() ? 'Next' : likely > 0 ? `Accept ${likely} likely, no other person` : 'No other person';
    done.replaceChildren(words, ' ', Object.assign(document.createElement('kbd'), { textContent: 'Enter' }));
  }

  private list(): void {
    const { people } = this;
    const lines: [string, boolean, () => void][] = [];
    for (const h of people.asked.open())
      lines.push([
        `person? ${percent(h.calibrated)}${people.asked.isSkipped(h) ? ', skipped' : ''}`,
        people.hypothesis()?.index === h.index,
        () => people.choose({ type: 'hypothesis', index: h.index }),
      ]);
    for (const label of people.windows())
      lines.push([
        `${isRejected(label) ? 'no person' : 'person'} ${label.id}, ${label.source}, ${label.who}`,
        people.window()?.id === label.id,
        () => people.choose({ type: 'window', id: label.id }),
      ]);
    const focused = document.activeElement?.parentElement?.parentElement?.id === 'people-list';
    const items = lines.map(([text, chosen, action]) => {
      const item = document.createElement('li');
      const button = document.createElement('button');
      button.textContent = text;
      button.setAttribute('aria-pressed', String(chosen));
      button.addEventListener('click', action);
      item.append(button);
      return item;
    });
    byId('people-list').replaceChildren(...items);
    if (focused) items.find((item) => item.firstElementChild!.getAttribute('aria-pressed') === 'true')?.querySelector('button')!.focus();
  }

  private cameras(): void {
    const { image } = this.people;
    const buttons = (image?.cameras ?? []).map((name, i) => {
      const button = document.createElement('button');
      const key = Object.assign(document.createElement('kbd'), { textContent: String(i + 1) });
      button.append(name, ' ', key);
      button.setAttribute('aria-pressed', String(i === image!.camera));
      button.addEventListener('click', () => void this.people.camera(i));
      return button;
    });
    byId('people-cameras').replaceChildren(...buttons);
  }

  private progress(): void {
    const { overview } = this.people;
    const list = document.createElement('dl');
    const add = (name: string, value: string, className = ''): void => {
      const dt = Object.assign(document.createElement('dt'), { textContent: name });
      const dd = Object.assign(document.createElement('dd'), { textContent: value, className });
      list.append(dt, dd);
    };
    add('images', `${overview.done} of ${overview.images} done, ${overview.queue.length} in the queue`);
    add('people', `${overview.persons} labelled${overview.learnt_before > 0 ? ', others learned before' : ''}`);
    const sum = (part: (r: PeopleRound) => number): number => overview.rounds.reduce((a, r) => a + part(r), 0);
    const [accepted, rejected, missed] = [sum((r) => r.accepted), sum((r) => r.rejected), sum((r) => r.missed)];
    if (accepted + rejected > 0)
      add('precision so far', `${percent(accepted / (accepted + rejected))} (${accepted} of ${accepted + rejected} likely hypotheses right)`);
    if (accepted + missed > 0) add('recall so far', `${percent(accepted / (accepted + missed))} (${missed} missed people drawn)`);
    if (overview.running) add('round', 'training …', 'running');
    const last = overview.rounds.at(-1);
    if (last)
      add(
        `round ${last.round}`,
        `${last.persons} people, ${last.nobody} windows without a person${last.again > 0 ? ` (${last.again} false alarms in finished images)` : ''}: ${last.found} likely in ${last.images} images (${last.seconds.toFixed(1)} s)`,
      );
    byId('people-progress').replaceChildren(list);
  }
}

function timeOf(t_ns: string): string {
  return new Date(Number(BigInt(t_ns) / 1000000n)).toISOString().slice(0, 21).replace('T', ' ');
}
