// Communicates with the server. The page sends changes one after another. Each change stays in the
// browser's storage until the server has stored it. A change that is sent again after a lost answer
// has the same name, so that the server stores it once. Each page keeps its own changes. The next
// page sends the changes of a closed page.
import { anchored } from './anchored';
import { boxFields } from '../ground/geometry';
import { entries, entryOf, readKept, writeKept, type Change, type Entry } from './kept_changes';
import { claimClosedPage } from './own_page';
import type { Box, ClassList, Draft, Fields, Label, Standing, Start } from '../types';

export interface LabelConflict {
  status: 'conflict';
  about: 'label';
  request: string;
  current: Label;
  yours: Fields & Standing;
  deletes: boolean;
}
export interface ClassConflict {
  status: 'conflict';
  about: 'classes';
  request: string;
  current: ClassList;
  yours: ClassList;
}
export type Outcome =
  /** `took`: for an undo or redo step, the name of the request that it reversed. */
  | { status: 'stored'; request: string; labels: Label[]; classes?: ClassList; took?: string }
  | LabelConflict
  | ClassConflict
  /**
   * The last change of this user, which the undo or redo step concerns, was made in another page.
   */
  | { status: 'otherPage'; message: string }
  /** An undo or redo step that depended on a step without effect. The page did not send it. */
  | { status: 'cancelled' }
  /** `isSetAside`: the change is kept in a separate entry. */
  | { status: 'refused'; message: string; isSetAside?: boolean };

export class ServerUnavailable extends Error {}
export class NotAllowed extends Error {}
/** The server failed on a change. The next attempt may succeed. */
class ServerFault extends Error {}
/** The server now has another map than the one on which the change was made. */
class OtherMap extends Error {}

const kRetryMs = 1000;
const kTries = 3; // attempts for a change on which the server fails
const kNothingToUndo = 'Nothing to undo: the change was not saved';

const isStepBack = (path: string): boolean => path === 'api/undo' || path === 'api/redo';

interface Waiting {
  change: Change;
  done(outcome: Outcome): void;
}

export async function fetchJson<T>(method: string, path: string, body?: unknown): Promise<T> {
  const { status, json } = await exchange(method, path, body);
  if (status >= 400) throw new Error(json.error ?? `status ${status}`);
  return json as T;
}

async function exchange(
  method: string,
  path: string,
  body?: unknown,
): Promise<{ status: number; json: any }> {
  let response: Response;
  try {
    response = await fetch(path, {
      method,
      headers: body === undefined ? {} : { 'Content-Type': 'application/json' },
      body: body === undefined ? undefined : JSON.stringify(body),
      signal: AbortSignal.timeout(20000),
    });
  } catch {
    throw new ServerUnavailable('the server does not answer');
  }
  if (response.status === 401 || response.status === 403)
    throw new NotAllowed('the server has been restarted: open the address that it prints');
  try {
    return { status: response.status, json: await response.json() };
  } catch {
    throw new ServerUnavailable('the server closed the connection');
  }
}

export class ChangeQueue {
  private readonly waiting: Waiting[] = [];
  private running = false;
  /** By path: the versions of a label from the first to the last change of this page. */
  private readonly versionRanges = new Map<string, { from: number; to: number; when: string }>();

  private readonly entry: Entry;
  /** The prefix of the names of this page's requests. */
  readonly names: string;
  /**
   * Changes that conflict with an earlier change of another user. The page keeps them until the
   * user decides between the versions.
   */
  private conflicting: Change[] = [];
  private failures = 0;
  private stopped = false;
  private isSavedToBrowser = true;
  /** Called when a change on which the server fails was moved to a separate entry. */
  onSetAside = (_entry: Entry, _why: string): void => {};
  /** Called when the server has another map than this page. */
  onOtherMap = (): void => {};

  /**
   * The queue of one page on one map. `report(message, count)` reports the waiting changes; an empty
   * message means that nothing is wrong.
   */
  constructor(
    private readonly map: Pick<Start, 'map' | 'name' | 'place' | 'poses'>,
    page: string,
    private readonly report: (message: string, count: number) => void,
  ) {
    this.entry = entryOf(map.map, page);
    this.names = `${page}/`;
  }

  /** Returns a name for a change. The server accepts up to 64 characters. */
  newName(): string {
    return (this.names + crypto.randomUUID()).slice(0, 64);
  }

  /** Sends the unsent changes of this page before its reload, and those of closed pages. */
  async resume(done: (outcome: Outcome) => void): Promise<void> {
    const kept: Change[] = [];
    const others: Entry[] = [];
    for (const entry of entries()) {
      if (entry.map !== this.map.map) continue;
      const own = entry.key === this.entry.key;
      if (!own && !(await claimClosedPage(entry.page))) continue;
      kept.push(...readKept(entry).changes);
      if (!own) others.push(entry);
    }
    this.waiting.unshift(...kept.map((change) => ({ change, done })));
    this.saveToBrowser(); // keep first: a change that is kept twice is sent twice but stored once
    if (this.isSavedToBrowser) for (const { key } of others) localStorage.removeItem(key);
    void this.run();
  }

  /** `shape` is the complete shape of the changed object, if the body has only a part of it. */
  send(method: Change['method'], path: string, body: Record<string, unknown>, request: string, shape?: Fields): Promise<Outcome> {
    return new Promise((done) => {
      const later = anchored(this.map.poses, body, shape);
      const change: Change = { request, method, path, body: { ...body, request, map: this.map.map }, later };
      this.rebase(change);
      this.waiting.push({ change, done });
      this.saveToBrowser();
      void this.run();
    });
  }

  /** Returns the boxes that wait to be stored. */
  boxes(): (Box & { kind: string })[] {
    const drafts = this.waiting.flatMap(({ change: { method, path, body } }) =>
      method === 'POST' && path === 'api/labels' ? ((body.labels ?? [body]) as Draft[]) : [],
    );
    return drafts.flatMap((draft) => (draft.shape === 'box' ? [{ ...boxFields(draft as Box), kind: draft.kind }] : []));
  }

  get count(): number {
    return this.waiting.length;
  }

  /** Waits until the server has answered all changes sent so far. */
  async idle(): Promise<void> {
    while (this.waiting.length > 0) await new Promise((later) => setTimeout(later, 20));
  }

  /** Stops sending. The waiting changes stay in the storage for a page of their own map. */
  stop(): void {
    this.stopped = true;
  }

  /** The user has decided the conflict about this request. */
  resolveConflict(request: string): void {
    this.conflicting = this.conflicting.filter((change) => change.request !== request);
    this.saveToBrowser();
  }

  // Without room in the browser's storage, the waiting changes are lost when the page is closed.
  // Nothing else is lost.
  private saveToBrowser(): void {
    const { name, place } = this.map;
    const changes = [...this.conflicting, ...this.waiting.map((w) => w.change)];
    this.isSavedToBrowser = writeKept(this.entry, { name, place, changes });
    if (!this.isSavedToBrowser) this.report('the browser storage is full: keep this page open until all changes are saved', changes.length);
  }

  private async run(): Promise<void> {
    if (this.running) return;
    this.running = true;
    while (this.waiting.length > 0 && !this.stopped) await this.sendFirst();
    this.running = false;
  }

  private async sendFirst(): Promise<void> {
    const { change } = this.waiting[0];
    try {
      const outcome = await this.deliver(change);
      if (outcome.status === 'conflict' && change.method !== 'POST') this.conflicting.push(change);
      this.finishFirst(outcome);
    } catch (fault) {
      if (fault instanceof OtherMap) {
        this.stop();
        return this.onOtherMap();
      }
      const { message } = fault as Error;
      if (fault instanceof ServerFault && ++this.failures >= kTries && this.setAside(change, message)) return;
      this.report(message, this.waiting.length);
      await new Promise((later) => setTimeout(later, kRetryMs));
    }
  }

  // Handles the outcome of the first waiting change.
  private finishFirst(outcome: Outcome): void {
    const { change, done } = this.waiting.shift()!;
    this.failures = 0;
    const idle = this.removeUndosWithoutEffect(change, outcome);
    const dependent = this.removeDependentUndos(change, outcome);
    if (outcome.status === 'stored') this.recordVersions(outcome.labels);
    this.saveToBrowser();
    done(outcome);
    const why = outcome.status === 'refused' ? ` (${outcome.message})` : '';
    for (const { done: left } of idle) left({ status: 'refused', message: kNothingToUndo + why });
    for (const { done: left } of dependent) left({ status: 'cancelled' });
    this.report('', this.waiting.length);
  }

  // Moves a change to a separate entry of the browser's storage, so that it does not delay the other
  // changes. Returns false if the storage is full.
  private setAside(change: Change, why: string): boolean {
    const { map, name, place } = this.map;
    const entry = entryOf(map, crypto.randomUUID());
    if (!writeKept(entry, { name, place, changes: [change] })) return false;
    void claimClosedPage(entry.page);
    this.finishFirst({ status: 'refused', message: why, isSetAside: true });
    this.onSetAside(entry, why);
    return true;
  }

  // Removes the undo steps of a change without effect from the queue, because the server would undo
  // an older change instead. Also removes the steps that refer to these steps. Returns them.
  private removeUndosWithoutEffect({ request }: Change, outcome: Outcome): Waiting[] {
    if (outcome.status === 'stored' && (outcome.labels.length > 0 || outcome.classes)) return [];
    const idle: Waiting[] = [];
    const names = new Set([request]);
    for (const step of [...this.waiting]) {
      if (!names.has(step.change.body.last as string)) continue;
      names.add(step.change.request);
      this.waiting.splice(this.waiting.indexOf(step), 1);
      idle.push(step);
    }
    return idle;
  }

  // A second press of undo means the step before the first one. If the first undo fails, the second
  // one is removed from the queue too. Returns the removed steps.
  private removeDependentUndos({ path }: Change, outcome: Outcome): Waiting[] {
    if (!isStepBack(path) || (outcome.status !== 'conflict' && outcome.status !== 'otherPage')) return [];
    const dependent: Waiting[] = [];
    const undoable = new Set<unknown>(); // names of requests that can still be undone
    for (const one of [...this.waiting]) {
      const { request, path: to, body } = one.change;
      if (!isStepBack(to) || undoable.has(body.last)) {
        undoable.add(request);
        continue;
      }
      dependent.push(one);
      this.waiting.splice(this.waiting.indexOf(one), 1);
    }
    return dependent;
  }

  // Records the new versions of changed labels, and bases the waiting changes on them.
  private recordVersions(labels: Label[]): void {
    for (const { id, version, when } of labels) {
      const path = `api/labels/${id}`;
      const before = this.versionRanges.get(path);
      this.versionRanges.set(path, { from: before?.to === version - 1 ? before.from : version - 1, to: version, when });
    }
    for (const { change } of this.waiting) this.rebase(change);
  }

  // A change that was made on an unconfirmed change is now based on the result of that change.
  private rebase({ path, body }: Change): void {
    const range = this.versionRanges.get(path);
    const version = body.version as number;
    if (!range || version < range.from || version >= range.to) return;
    body.version = range.to;
    body.when = range.when;
  }

  private async deliver(change: Change): Promise<Outcome> {
    const { status, json } = await exchange(change.method, change.path, change.body);
    const deletes = change.method === 'DELETE';
    const about = json.current?.classes ? 'classes' : 'label';
    if (status === 409 && json.map) throw new OtherMap(json.error);
    const { request } = change;
    if (status === 409) return { status: 'conflict', about, request, current: json.current, yours: json.yours, deletes };
    // These states may be temporary: a full disk, a busy server or a slow transfer. The page sends
    // the change again.
    if (status === 507 || status === 503 || status === 408) throw new ServerUnavailable(json.error);
    if (status >= 500) throw new ServerFault(json.error ?? `server error (status ${status})`);
    if (status === 412) return { status: 'otherPage', message: json.error };
    if (status >= 400) return { status: 'refused', message: json.error ?? `status ${status}` };
    const labels = (json.labels ?? (json.id === undefined ? [] : [json])) as Label[];
    return { status: 'stored', request, labels, classes: json.classes, took: json.took };
  }
}
