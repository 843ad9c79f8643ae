// Communicates with the server. The page sends changes one after another. Each change stays in the
// browser's storage until the server has stored it. A change that is sent again after a lost answer
// has the same name, so that the server stores it once. Each page keeps its own changes. The next
// page sends the changes of a closed page.
import { anchored } from './anchored';
import { boxFields } from '../ground/geometry';
import { entries, entryOf, readKept, writeKept, type Change, type Entry } from './kept_changes';
import { inherits } from './own_page';
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
  | { status: 'elsewhere'; message: string }
  /** An undo or redo step that waited behind another one without result. */
  | { status: 'behind' }
  /** `aside`: the change is kept in a separate entry. */
  | { status: 'refused'; message: string; aside?: boolean };

export class ServerAway extends Error {}
export class NotAllowed extends Error {}
/** The server failed on a change. The next attempt may succeed. */
class ServerFault extends Error {}
/** The server now has another map than the one on which the change was made. */
class OtherMap extends Error {}

const kRetryMs = 1000;
const kTries = 3; // attempts for a change on which the server fails
const kNothingCame = 'Nothing to undo: the change was not saved';

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
    throw new ServerAway('the server does not answer');
  }
  if (response.status === 401 || response.status === 403)
    throw new NotAllowed('the server has been restarted: open the address that it prints');
  try {
    return { status: response.status, json: await response.json() };
  } catch {
    throw new ServerAway('the server closed the connection');
  }
}

export class ChangeQueue {
  private readonly waiting: Waiting[] = [];
  private running = false;
  /** By path: the range of versions through which this page's changes have brought a label. */
  private readonly brought = new Map<string, { from: number; to: number; when: string }>();

  private readonly entry: Entry;
  /** The prefix of the names of this page's requests. */
  readonly names: string;
  /**
   * Changes that conflict with an earlier change of another user. The page keeps them until the
   * user decides between the versions.
   */
  private undecided: Change[] = [];
  private faults = 0;
  private stopped = false;
  private kept = true;
  /** Called when a change on which the server fails was moved to a separate entry. */
  putAside = (_entry: Entry, _why: string): void => {};
  /** Called when the server has another map than this page. */
  otherMap = (): void => {};

  /**
   * The queue of one page on one map. `told(message, count)` reports the waiting changes; an empty
   * message means that nothing is wrong.
   */
  constructor(
    private readonly map: Pick<Start, 'map' | 'name' | 'place' | 'poses'>,
    page: string,
    private readonly told: (message: string, count: number) => void,
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
      if (!own && !(await inherits(entry.page))) continue;
      kept.push(...readKept(entry).changes);
      if (!own) others.push(entry);
    }
    this.waiting.unshift(...kept.map((change) => ({ change, done })));
    this.keep(); // keep first: a change that is kept twice is sent twice but stored once
    if (this.kept) for (const { key } of others) localStorage.removeItem(key);
    void this.run();
  }

  /** `shape` is the complete shape of the changed object, if the body has only a part of it. */
  send(method: Change['method'], path: string, body: Record<string, unknown>, request: string, shape?: Fields): Promise<Outcome> {
    return new Promise((done) => {
      const later = anchored(this.map.poses, body, shape);
      const change: Change = { request, method, path, body: { ...body, request, map: this.map.map }, later };
      this.goOn(change);
      this.waiting.push({ change, done });
      this.keep();
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
  decided(request: string): void {
    this.undecided = this.undecided.filter((change) => change.request !== request);
    this.keep();
  }

  // Without room in the browser's storage, the waiting changes are lost when the page is closed.
  // Nothing else is lost.
  private keep(): void {
    const { name, place } = this.map;
    const changes = [...this.undecided, ...this.waiting.map((w) => w.change)];
    this.kept = writeKept(this.entry, { name, place, changes });
    if (!this.kept) this.told('the browser storage is full: keep this page open until all changes are saved', changes.length);
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
      if (outcome.status === 'conflict' && change.method !== 'POST') this.undecided.push(change);
      this.take(outcome);
    } catch (fault) {
      if (fault instanceof OtherMap) {
        this.stop();
        return this.otherMap();
      }
      const { message } = fault as Error;
      if (fault instanceof ServerFault && ++this.faults >= kTries && this.aside(change, message)) return;
      this.told(message, this.waiting.length);
      await new Promise((later) => setTimeout(later, kRetryMs));
    }
  }

  // Handles the outcome of the first waiting change.
  private take(outcome: Outcome): void {
    const { change, done } = this.waiting.shift()!;
    this.faults = 0;
    const idle = this.takenBackInVain(change, outcome);
    const behind = this.behind(change, outcome);
    if (outcome.status === 'stored') this.bring(outcome.labels);
    this.keep();
    done(outcome);
    const why = outcome.status === 'refused' ? ` (${outcome.message})` : '';
    for (const { done: left } of idle) left({ status: 'refused', message: kNothingCame + why });
    for (const { done: left } of behind) left({ status: 'behind' });
    this.told('', this.waiting.length);
  }

  // Moves a change to a separate entry, as if a closed page had left it. Then the other changes
  // need not wait behind it. Returns false if the browser has no room for the entry.
  private aside(change: Change, why: string): boolean {
    const { map, name, place } = this.map;
    const entry = entryOf(map, crypto.randomUUID());
    if (!writeKept(entry, { name, place, changes: [change] })) return false;
    void inherits(entry.page);
    this.take({ status: 'refused', message: why, aside: true });
    this.putAside(entry, why);
    return true;
  }

  // Handles undo steps that wait behind a change without result. They were meant for this change,
  // and the server would undo an older change instead. Therefore they leave the queue, together
  // with the steps that were meant for them.
  private takenBackInVain({ request }: Change, outcome: Outcome): Waiting[] {
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

  // A user who presses undo twice means the previous step with the second press. This step depends
  // on the first one.
  private behind({ path }: Change, outcome: Outcome): Waiting[] {
    if (!isStepBack(path) || (outcome.status !== 'conflict' && outcome.status !== 'elsewhere')) return [];
    const behind: Waiting[] = [];
    const coming = new Set<unknown>(); // names of requests that can still be undone
    for (const one of [...this.waiting]) {
      const { request, path: to, body } = one.change;
      if (!isStepBack(to) || coming.has(body.last)) {
        coming.add(request);
        continue;
      }
      behind.push(one);
      this.waiting.splice(this.waiting.indexOf(one), 1);
    }
    return behind;
  }

  // Records that each change brings a label from one version to the next.
  private bring(labels: Label[]): void {
    for (const { id, version, when } of labels) {
      const path = `api/labels/${id}`;
      const before = this.brought.get(path);
      this.brought.set(path, { from: before?.to === version - 1 ? before.from : version - 1, to: version, when });
    }
    for (const { change } of this.waiting) this.goOn(change);
  }

  // A change that was made on an unconfirmed change is now based on the result of that change.
  private goOn({ path, body }: Change): void {
    const brought = this.brought.get(path);
    const version = body.version as number;
    if (!brought || version < brought.from || version >= brought.to) return;
    body.version = brought.to;
    body.when = brought.when;
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
    if (status === 507 || status === 503 || status === 408) throw new ServerAway(json.error);
    if (status >= 500) throw new ServerFault(json.error ?? `server error (status ${status})`);
    if (status === 412) return { status: 'elsewhere', message: json.error };
    if (status >= 400) return { status: 'refused', message: json.error ?? `status ${status}` };
    const labels = (json.labels ?? (json.id === undefined ? [] : [json])) as Label[];
    return { status: 'stored', request, labels, classes: json.classes, took: json.took };
  }
}
