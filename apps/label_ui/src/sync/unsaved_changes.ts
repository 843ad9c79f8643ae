// Changes in this browser that the page does not send by itself. They were made on another map than
// the page shows, or the server failed on them. The user decides about them.
import { hasMapCoordinates } from './anchored';
import { entries, readKept, writeKept, type Change, type Entry, type Kept } from './kept_changes';
import { byId } from '../panels/messages';
import { claimClosedPage } from './own_page';
import type { ChangeQueue, Outcome } from './server';
import type { Start } from '../types';

export class UnsavedChanges {
  /** The kept changes, each with the reason if the server refused it. */
  private readonly found = new Map<string, { entry: Entry; why: string }>();

  constructor(
    private readonly start: Start,
    private readonly queue: ChangeQueue,
    private readonly onOutcome: (outcome: Outcome) => void,
  ) {
    queue.onSetAside = (entry, why) => this.add(entry, why);
  }

  /** Finds the changes of closed pages, and those of this page (`own`) before it was reloaded. */
  async find(own: string): Promise<void> {
    for (const entry of entries()) {
      if (entry.map === this.start.map) continue; // the page sends these by itself
      if (entry.page === own || (await claimClosedPage(entry.page))) this.add(entry, '');
    }
  }

  private add(entry: Entry, why: string): void {
    this.found.set(entry.key, { entry, why });
    this.show();
  }

  private isOfThisPlace({ map }: Entry, { place }: Kept): boolean {
    return map === this.start.map || place === this.start.place;
  }

  private describe(entry: Entry, kept: Kept): string {
    if (entry.map === this.start.map) return 'could not be saved';
    if (this.isOfThisPlace(entry, kept)) return `not saved: made on ${kept.name} before this map was rebuilt`;
    return `not saved: made on another map${kept.name ? `, ${kept.name}` : ''}`;
  }

  private show(): void {
    const lines = [...this.found.values()].flatMap((left) => {
      const kept = readKept(left.entry);
      if (kept.changes.length === 0) this.found.delete(left.entry.key);
      return kept.changes.length === 0 ? [] : [this.line(left.entry, kept, left.why)];
    });
    byId('left-list').replaceChildren(...lines);
    byId('left').hidden = lines.length === 0;
  }

  private line(entry: Entry, kept: Kept, why: string): HTMLElement {
    const item = document.createElement('li');
    const button = (text: string, action: () => void): HTMLElement => {
      const made = Object.assign(document.createElement('button'), { textContent: text });
      made.addEventListener('click', action);
      return made;
    };
    const { length } = kept.changes;
    item.append(`${length} ${length > 1 ? 'changes' : 'change'} ${this.describe(entry, kept)}${why && `: ${why}`}`);
    if (this.isOfThisPlace(entry, kept)) item.append(button('Send', () => void this.send(entry)));
    item.append(
      button('Save as file', () => save(kept)),
      button('Discard', () => this.discard(entry, length)),
    );
    return item;
  }

  // Sends the changes under their old names, so that the server stores none twice. Changes that do
  // not apply stay here. Places move with the vehicle poses at which they were drawn. A place
  // without such a pose is not sent.
  private async send(entry: Entry): Promise<void> {
    const kept = readKept(entry);
    this.found.delete(entry.key);
    this.show();
    const stay: Change[] = [];
    const reasons = new Set<string>();
    await Promise.all(
      kept.changes.map(async (change) => {
        const moved = entry.map !== this.start.map;
        if (moved && !change.later && hasMapCoordinates(change.body)) {
          stay.push(change);
          reasons.add('the rebuilt map has no pose for this place');
          return;
        }
        const body = moved ? { ...change.body, ...change.later } : change.body;
        const outcome = await this.queue.send(change.method, change.path, body, change.request);
        if (outcome.status === 'refused' || outcome.status === 'otherPage') {
          if (outcome.status !== 'refused' || !outcome.isSetAside) stay.push(change);
          reasons.add(outcome.message);
        } else {
          this.onOutcome(outcome);
        }
      }),
    );
    writeKept(entry, { ...kept, changes: stay });
    this.add(entry, [...reasons].join('; '));
  }

  private discard(entry: Entry, count: number): void {
    if (!window.confirm(`Discard ${count > 1 ? `these ${count} changes` : 'this change'}?`)) return;
    localStorage.removeItem(entry.key);
    this.show();
  }
}

function save(kept: Kept): void {
  const address = URL.createObjectURL(new Blob([JSON.stringify(kept, null, 1)], { type: 'application/json' }));
  const link = Object.assign(document.createElement('a'), { href: address, download: `${kept.name || 'map'}_changes.json` });
  link.click();
  URL.revokeObjectURL(address);
}
