// Talks to the server. Changes go out one after another and stay in the browser's storage until the
// server has stored them: a change that is sent again after a lost answer carries the same name, so
// that it is stored once. Each page keeps its own; those of a page that is gone go out with the next.
import { inherits } from './own_page';
import type { ClassList, Fields, Label } from './types';

export interface Change {
  request: string;
  method: 'POST' | 'PUT' | 'DELETE';
  path: string;
  body: Record<string, unknown>;
}

export type Outcome =
  | { status: 'stored'; request: string; labels: Label[]; classes?: ClassList }
  | { status: 'conflict'; about: 'label'; current: Label; yours: Fields & { version: number }; deletes: boolean }
  | { status: 'conflict'; about: 'classes'; current: ClassList; yours: ClassList }
  /** A step back, and what this person did last was done in another page. */
  | { status: 'elsewhere'; message: string }
  | { status: 'refused'; message: string };

export class ServerAway extends Error {}
export class NotAllowed extends Error {}

const kRetryMs = 1000;
const kNothingCame = 'nothing to take back: that change was not stored';

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
    throw new NotAllowed('this page belongs to a server that has ended: open the address it prints');
  try {
    return { status: response.status, json: await response.json() };
  } catch {
    throw new ServerAway('the server broke off');
  }
}

/** What waits in an entry of the browser's storage; nothing where that cannot be read. */
function changesIn(place: string): Change[] {
  try {
    const kept: unknown = JSON.parse(localStorage.getItem(place) ?? '[]');
    return Array.isArray(kept) ? (kept as Change[]) : [];
  } catch {
    return [];
  }
}

export class ChangeQueue {
  private readonly waiting: Waiting[] = [];
  private running = false;
  /** By path: from which version to which changes of this page have brought a label. */
  private readonly brought = new Map<string, { from: number; to: number }>();

  private readonly place: string;
  /** What the names of this page's requests begin with. */
  readonly names: string;

  /** Of one page on one map. `told(message, count)`: nothing to wait for where the message is empty. */
  constructor(
    private readonly map: string,
    page: string,
    private readonly told: (message: string, count: number) => void,
  ) {
    this.place = `${map}/${page}`;
    this.names = `${page}/`;
  }

  /** For a change: the server takes up to 64 letters. */
  newName(): string {
    return (this.names + crypto.randomUUID()).slice(0, 64);
  }

  /** Sends what this page before it was loaded again, and pages that are gone, could not. */
  async resume(done: (outcome: Outcome) => void): Promise<void> {
    const kept: Change[] = [];
    const others: string[] = [];
    for (const place of Object.keys(localStorage)) {
      if (place !== this.map && !place.startsWith(`${this.map}/`)) continue;
      if (place !== this.place && !(await inherits(place.slice(this.map.length + 1)))) continue;
      kept.push(...changesIn(place));
      if (place !== this.place) others.push(place);
    }
    this.waiting.unshift(...kept.map((change) => ({ change, done })));
    this.keep(); // first: what is kept twice is sent twice and stored once
    for (const place of others) localStorage.removeItem(place);
    void this.run();
  }

  send(method: Change['method'], path: string, body: Record<string, unknown>, request: string): Promise<Outcome> {
    return new Promise((done) => {
      const change: Change = { request, method, path, body: { ...body, request } };
      this.goOn(change);
      this.waiting.push({ change, done });
      this.keep();
      void this.run();
    });
  }

  /** When everything sent so far has its answer. */
  async idle(): Promise<void> {
    while (this.waiting.length > 0) await new Promise((later) => setTimeout(later, 20));
  }

  private keep(): void {
    if (this.waiting.length === 0) localStorage.removeItem(this.place);
    else localStorage.setItem(this.place, JSON.stringify(this.waiting.map((w) => w.change)));
  }

  private async run(): Promise<void> {
    if (this.running) return;
    this.running = true;
    while (this.waiting.length > 0) {
      const { change, done } = this.waiting[0];
      try {
        const outcome = await this.deliver(change);
        this.waiting.shift();
        const idle = this.takenBackInVain(change, outcome);
        if (outcome.status === 'stored') this.bring(outcome.labels);
        this.keep();
        done(outcome);
        for (const step of idle) step.done({ status: 'refused', message: kNothingCame });
      } catch (fault) {
        this.told((fault as Error).message, this.waiting.length);
        await new Promise((later) => setTimeout(later, kRetryMs));
        continue;
      }
      this.told('', this.waiting.length);
    }
    this.running = false;
  }

  // Steps back that wait behind a change of which nothing came were meant for it: the server would take
  // an older one for the last. They leave the queue, and so do steps that were meant for them.
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

  // Each change brings a label from one version to the next.
  private bring(labels: Label[]): void {
    for (const { id, version } of labels) {
      const path = `api/labels/${id}`;
      const before = this.brought.get(path);
      this.brought.set(path, { from: before?.to === version - 1 ? before.from : version - 1, to: version });
    }
    for (const { change } of this.waiting) this.goOn(change);
  }

  // A change made on top of one that was still on its way begins from what came of that one.
  private goOn({ path, body }: Change): void {
    const brought = this.brought.get(path);
    const version = body.version as number;
    if (brought && version >= brought.from && version < brought.to) body.version = brought.to;
  }

  private async deliver(change: Change): Promise<Outcome> {
    const { status, json } = await exchange(change.method, change.path, change.body);
    const deletes = change.method === 'DELETE';
    const about = json.current?.classes ? 'classes' : 'label';
    if (status === 409) return { status: 'conflict', about, current: json.current, yours: json.yours, deletes };
    // A full disk may have room again; the change stays and is sent again.
    if (status === 507 || status === 503) throw new ServerAway(json.error);
    if (status === 412) return { status: 'elsewhere', message: json.error };
    if (status >= 400) return { status: 'refused', message: json.error ?? `status ${status}` };
    const labels = (json.labels ?? (json.id === undefined ? [] : [json])) as Label[];
    return { status: 'stored', request: change.request, labels, classes: json.classes };
  }
}
