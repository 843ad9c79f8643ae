// The list of questions, labels or events. The page contains only the visible rows, so that ten
// thousand rows cost as little as ten.
import { fetchJson } from '../sync/server';
import type { Selection, Store } from '../store';
import type { Notifier } from '../work';
import { isOnGround, isRejected, needsCheck, type HistoryEvent, type Hypothesis, type Label } from '../types';

const kRowPx = 28;
const kFollowMs = 150;

interface Row {
  key: string;
  title: string;
  detail: string;
  colour: string;
  text: string; // searched
  select: () => void;
}

const kNewest: [string, string] = ['new', 'newest first'];
const kOfLabels: [string, string][] = [
  ['uncertain', 'least certain first'], kNewest, ['number', 'number'], ['class', 'class'],
];
/** The sort orders of each list. */
const kOrders: Record<string, [string, string][]> = {
  questions: [['telling', 'most informative first'], ['uncertain', 'least certain first'], ['likely', 'most likely first']],
  labels: kOfLabels,
  rejected: kOfLabels,
  look: kOfLabels,
  history: [kNewest],
};

export class List {
  private rows: Row[] = [];
  private timer = 0;
  private events: HistoryEvent[] = [];
  /** The row that was selected last. Several rows may be about the same label. */
  private selectedEvent = '';
  private readonly chosenOrders = new Map<string, string>();
  private readonly what: HTMLSelectElement;
  private readonly order: HTMLSelectElement;
  private readonly search: HTMLInputElement;

  constructor(
    private readonly store: Store,
    private readonly box: HTMLElement,
    private readonly count: HTMLElement,
    private readonly onSelected: () => void,
    private readonly notifier: Pick<Notifier, 'showWindows' | 'warn'>,
  ) {
    this.what = document.querySelector('#list-what')!;
    this.order = document.querySelector('#list-order')!;
    this.search = document.querySelector('#search')!;
    this.what.addEventListener('change', () => {
      this.fillOrders();
      void this.refresh();
    });
    this.order.addEventListener('change', () => {
      this.chosenOrders.set(this.what.value, this.order.value);
      this.fill();
    });
    this.fillOrders();
    this.search.addEventListener('input', () => this.fill());
    box.addEventListener('scroll', () => this.paint());
    box.addEventListener('click', (event) => this.click(event));
    box.addEventListener('keydown', (event) => this.key(event));
    new ResizeObserver(() => this.paint()).observe(box);
    store.on('labels', () => this.scheduleRefresh());
    store.on('hypotheses', () => this.fill());
    store.on('selection', () => this.scrollToSelected());
  }

  private fillOrders(): void {
    const orders = kOrders[this.what.value];
    this.order.replaceChildren(...orders.map(([value, text]) => new Option(text, value)));
    this.order.value = this.chosenOrders.get(this.what.value) ?? orders[0][0];
  }

  // Keys can move a label quickly. The list is updated a little later.
  private scheduleRefresh(): void {
    if (this.timer !== 0) return;
    this.timer = window.setTimeout(() => {
      this.timer = 0;
      void this.refresh().then(() => this.scrollToSelected());
    }, kFollowMs);
  }

  private async refresh(): Promise<void> {
    if (this.what.value === 'history') {
      try {
        this.events = (await fetchJson<{ events: HistoryEvent[] }>('GET', 'api/history')).events;
      } catch {
        // The status line already reports that the server is not available.
      }
    }
    this.fill();
  }

  private fill(): void {
    const wanted = this.search.value.trim().toLowerCase();
    this.rows = this.unfiltered().filter((row) => row.text.toLowerCase().includes(wanted));
    const word = this.what.value === 'history' ? 'events' : this.what.options[this.what.selectedIndex].text;
    this.count.textContent = `${this.rows.length} ${word}${wanted ? ' found' : ''}`;
    this.paint();
  }

  private unfiltered(): Row[] {
    switch (this.what.value) {
      case 'questions':
        return this.hypothesisRows();
      case 'history':
        return this.events.map((event) => this.eventRow(event));
      case 'look':
        return this.labelRows(needsCheck);
      case 'rejected':
        return this.labelRows(isRejected);
      default:
        return this.labelRows((label) => !isRejected(label));
    }
  }

  private hypothesisRows(): Row[] {
    const doubt = (h: Hypothesis): number => Math.abs(h.calibrated - 0.5); // as displayed
    const list = [...this.store.hypotheses.values()];
    // The open questions come first, in the order in which the page asks them. The other hypotheses
    // follow, the least certain first.
    const rank = new Map(this.store.questions.map((index, i) => [index, i]));
    const telling = (h: Hypothesis): number => rank.get(h.index) ?? 1e6 + doubt(h);
    if (this.order.value === 'telling') list.sort((a, b) => telling(a) - telling(b));
    else if (this.order.value === 'uncertain') list.sort((a, b) => doubt(a) - doubt(b));
    else list.sort((a, b) => b.probability - a.probability);
    const { title, colour } = this.store.classOf(this.store.hypothesisKind);
    return list.map((h) => {
      const skipped = this.store.skipped.has(h.index) ? ', skipped' : '';
      const percent = Math.round(100 * h.calibrated);
      return {
        key: `h${h.index}`,
        title: `${title}?${skipped}`,
        detail: `${percent} %`,
        colour,
        text: `${title} ${percent}`,
        select: () => this.pick({ type: 'hypothesis', index: h.index }),
      };
    });
  }

  private labelRows(wanted: (label: Label) => boolean): Row[] {
    const list = this.store.active().filter(wanted);
    const by: Record<string, (a: Label, b: Label) => number> = {
      uncertain: (a, b) => (b.sigma_m ?? 0) - (a.sigma_m ?? 0),
      new: (a, b) => (a.when < b.when ? 1 : a.when > b.when ? -1 : b.id - a.id),
      number: (a, b) => a.id - b.id,
      class: (a, b) => a.kind.localeCompare(b.kind) || a.id - b.id,
    };
    list.sort(by[this.order.value]);
    return list.map((label) => {
      const { title, colour } = this.store.classOf(label.kind);
      const rejected = isRejected(label);
      const moved = label.moved_m === undefined ? '' : `moved ${(label.moved_m * 100).toFixed(0)} cm, `;
      const apart = label.further?.contradicts ? `${(label.further.apart_m * 100).toFixed(0)} cm between images, ` : '';
      const gone = label.gone ? 'paint missing, ' : '';
      const sigma = label.sigma_m === undefined ? 'no place in the map' : `± ${(label.sigma_m * 100).toFixed(0)} cm`;
      return {
        key: `l${label.id}`,
        title: `${label.id} ${rejected ? 'no ' : ''}${title}${label.note ? ` – ${label.note}` : ''}`,
        detail: `${gone}${moved}${apart}${sigma}, ${label.source}, ${label.who}`,
        colour,
        text: `${label.id} ${title} ${label.note} ${label.source} ${label.who}`,
        select: () => this.pick({ type: 'label', id: label.id }),
      };
    });
  }

  private eventRow({ event, who, when, action, undoes, id, kind }: HistoryEvent): Row {
    const { title: name, colour } = this.store.classOf(kind);
    const thing = id === 0 ? 'the classes' : `label ${id}, ${kind.startsWith('not_') ? 'no ' : ''}${name}`;
    const word = undoes ? `undo of ${undoes}:` : id === 0 ? 'change' : action;
    const title = `${event}: ${who}: ${word} ${thing}`;
    return {
      key: `e${event}`,
      title,
      detail: when.slice(0, 16).replace('T', ' '),
      colour,
      text: `${title} ${kind}`,
      select: () => this.showLabelOfEvent(id),
    };
  }

  // Shows the current state of the label of an event, on the ground or in its image.
  private showLabelOfEvent(id: number): void {
    const label = this.store.labels.get(id);
    if (label && !label.deleted && isOnGround(label)) this.pick({ type: 'label', id });
    else if (label && !label.deleted) this.notifier.showWindows([label]);
    else if (id !== 0) this.notifier.warn(`Label ${id} is deleted`);
  }

  private pick(selection: Selection): void {
    this.store.select(selection);
    this.onSelected();
  }

  private selectedRow(): number {
    const s = this.store.selection;
    if (this.what.value === 'history') return this.rows.findIndex((row) => row.key === this.selectedEvent);
    const key = s.type === 'label' ? `l${s.id}` : s.type === 'hypothesis' ? `h${s.index}` : '';
    return this.rows.findIndex((row) => row.key === key);
  }

  private paint(): void {
    const first = Math.max(0, Math.floor(this.box.scrollTop / kRowPx) - 4);
    const last = Math.min(this.rows.length, first + Math.ceil(this.box.clientHeight / kRowPx) + 8);
    const selected = this.selectedRow();
    const space = document.createElement('div');
    space.style.height = `${this.rows.length * kRowPx}px`;
    const lines: HTMLElement[] = [space];
    for (let i = first; i < last; ++i) lines.push(this.line(i, i === selected));
    const top = this.box.scrollTop;
    this.box.replaceChildren(...lines);
    if (this.box.scrollTop !== top) this.box.scrollTop = top;
    const shown = selected >= first && selected < last;
    if (shown) this.box.setAttribute('aria-activedescendant', `row-${this.rows[selected].key}`);
    else this.box.removeAttribute('aria-activedescendant');
  }

  private line(i: number, selected: boolean): HTMLElement {
    const row = this.rows[i];
    const line = document.createElement('div');
    line.id = `row-${row.key}`;
    line.className = 'line';
    line.style.top = `${i * kRowPx}px`;
    line.dataset.row = String(i);
    line.setAttribute('role', 'option');
    line.setAttribute('aria-selected', String(selected));
    line.setAttribute('aria-setsize', String(this.rows.length));
    line.setAttribute('aria-posinset', String(i + 1));
    const title = document.createElement('span');
    title.textContent = row.title;
    const detail = document.createElement('span');
    detail.textContent = row.detail;
    line.append(swatch(row.colour), title, detail);
    return line;
  }

  private scrollToSelected(): void {
    const selected = this.selectedRow();
    if (selected >= 0) {
      const top = selected * kRowPx;
      if (top < this.box.scrollTop) this.box.scrollTop = top;
      else if (top + kRowPx > this.box.scrollTop + this.box.clientHeight)
        this.box.scrollTop = top + kRowPx - this.box.clientHeight;
    }
    this.paint();
  }

  private choose(i: number): void {
    const row = this.rows[Math.max(0, Math.min(this.rows.length - 1, i))];
    if (!row) return;
    if (this.what.value === 'history') this.selectedEvent = row.key;
    row.select();
    this.scrollToSelected();
  }

  private click(event: MouseEvent): void {
    const line = (event.target as HTMLElement).closest<HTMLElement>('.line');
    if (line) this.choose(Number(line.dataset.row));
  }

  private key(event: KeyboardEvent): void {
    const page = Math.max(1, Math.floor(this.box.clientHeight / kRowPx) - 1);
    const now = this.selectedRow();
    const to: Record<string, number> = {
      ArrowDown: now + 1,
      ArrowUp: now - 1,
      PageDown: now + page,
      PageUp: now - page,
      Home: 0,
      End: this.rows.length - 1,
    };
    if (!(event.key in to)) return;
    event.preventDefault();
    event.stopPropagation();
    this.choose(to[event.key]);
  }
}

/** Makes a dot in a class's colour. It is an SVG, because the page allows no inline styles. */
export function swatch(colour: string): SVGElement {
  const svg = document.createElementNS('http://www.w3.org/2000/svg', 'svg');
  svg.setAttribute('class', 'swatch');
  svg.setAttribute('width', '12');
  svg.setAttribute('height', '12');
  svg.setAttribute('aria-hidden', 'true');
  const dot = document.createElementNS('http://www.w3.org/2000/svg', 'circle');
  for (const [key, value] of Object.entries({ cx: 6, cy: 6, r: 5, fill: colour, stroke: '#0006' }))
    dot.setAttribute(key, String(value));
  svg.append(dot);
  return svg;
}
