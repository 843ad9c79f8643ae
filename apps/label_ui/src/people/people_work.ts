// The labelling of people. The page shows one image at a time, the most useful first. It sends each
// answer at once, and the user can undo it. The server learns in the background.
import { LatestImage } from '../panels/latest_image';
import { AskedPeople } from './people_asked';
import { answerDraft, doneDrafts, drawnDraft, isLikely, kPerson } from './people_drafts';
import { PeopleDrawing } from './people_drawing';
import { PeopleRounds } from './people_rounds';
import { WindowShaping, reshaped } from './people_shaping';
import type { Store } from '../store';
import {
  imageName, isRejected, rejectedKind, sameImage,
  type ImageName, type Label, type PeopleImage, type PeopleOverview, type PersonHypothesis, type Point,
  type Upright, type WindowDraft,
} from '../types';
import type { Work } from '../work';

export type Chosen = { type: 'none' } | { type: 'hypothesis'; index: number } | { type: 'window'; id: number };

interface Notifier {
  status(message: string): void;
  warn(message: string): void;
  hint(message: string, bad?: boolean): void;
  /** Shows the images if the ground is in front. */
  showPeopleMode(): void;
}

export class PeopleWork {
  active = false;
  image: PeopleImage | null = null;
  chosen: Chosen = { type: 'none' };
  private readonly shown = new Set<string>();
  /** Images that are done but not stored yet. */
  private readonly beingSaved = new Set<string>();
  private wantsImage = false;
  private readonly latest = new LatestImage();
  private selectionCount = 0;
  readonly asked: AskedPeople;
  private readonly shaping: WindowShaping;
  private readonly rounds: PeopleRounds;
  readonly drawing: PeopleDrawing;
  private readonly listeners: (() => void)[] = [];

  constructor(
    private readonly store: Store,
    private readonly work: Work,
    private readonly notifier: Notifier,
  ) {
    this.shaping = new WindowShaping(
      (label, fields, from) => work.change(label, fields, from),
      () => this.notify(),
    );
    this.asked = new AskedPeople(this, (step) => work.addStep(step));
    work.flushWindows = () => this.flush();
    this.rounds = new PeopleRounds(store.start.map, notifier.status, notifier.warn, () => this.notify());
    this.drawing = new PeopleDrawing(notifier.hint, notifier.warn, (foot, head) => void this.drawn(foot, head), () => this.notify());
    store.on('labels', () => this.notify());
  }

  /** The points so far while the user is drawing. The feet come first. */
  get points(): Point[] | null {
    return this.drawing.points;
  }

  get overview(): PeopleOverview {
    return this.rounds.overview;
  }

  on(listener: () => void): void {
    this.listeners.push(listener);
  }

  notify(): void {
    if (this.active) for (const listener of this.listeners) listener();
  }

  activate(on: boolean): void {
    if (!on) this.flush();
    this.active = on;
    this.drawing.stop();
    this.notifier.hint('');
    this.notify();
    if (on && !this.image) void this.begin();
  }

  private async begin(): Promise<void> {
    await this.refresh();
    if (!this.image) await this.next();
  }

  // -- the displayed image

  windows(): Label[] {
    if (!this.image) return [];
    const labels = this.store.inImage(this.image).filter((label) => label.shape === 'upright');
    return labels.map((label) => this.shaping.shown(label));
  }

  isDone(): boolean {
    if (!this.image) return false;
    return this.beingSaved.has(imageName(this.image)) || this.store.inImage(this.image).some((label) => label.shape === 'image');
  }

  likely(): PersonHypothesis[] {
    return this.asked.open().filter((h) => isLikely(h) && !this.asked.isSkipped(h));
  }

  hypothesis(): PersonHypothesis | null {
    const { chosen } = this;
    return chosen.type === 'hypothesis' ? (this.asked.open().find((h) => h.index === chosen.index) ?? null) : null;
  }

  window(): Label | null {
    const { chosen } = this;
    return chosen.type === 'window' ? (this.windows().find((label) => label.id === chosen.id) ?? null) : null;
  }

  private flush(): void {
    this.asked.flush();
    this.shaping.flush();
  }

  choose(chosen: Chosen): void {
    ++this.selectionCount;
    this.select(chosen);
  }

  private select(chosen: Chosen): void {
    this.flush();
    this.chosen = chosen;
    this.notify();
  }

  // -- images

  refresh(): Promise<void> {
    return this.rounds.refresh();
  }

  async show(name: ImageName): Promise<void> {
    this.flush();
    try {
      const image = await this.latest.fetch(name);
      if (!image) return;
      this.image = image;
      this.wantsImage = false;
      this.drawing.clear();
      this.ask();
    } catch (fault) {
      this.notifier.warn((fault as Error).message);
    }
  }

  // Shows the image again after a change in it. If another image is already loading, that image has
  // priority.
  private async showAgain(image: PeopleImage): Promise<void> {
    if (this.image && sameImage(this.image, image) && !this.latest.isLoading) await this.show(image);
  }

  /** Shows an image in which a step was undone or redone. */
  async showStep(image: ImageName, name: string): Promise<void> {
    this.notifier.showPeopleMode();
    if (!this.image || !sameImage(this.image, image)) await this.show(image);
    if (!this.image || !sameImage(this.image, image)) return; // another image was requested in the meantime
    const h = this.asked.open().find((one) => this.asked.nameOf(one) === name);
    if (h) this.choose({ type: 'hypothesis', index: h.index });
    else this.ask();
  }

  /** Shows the most useful image that was not shown yet. If there is none, starts a round. */
  async next(): Promise<void> {
    if (this.image) this.shown.add(imageName(this.image));
    const waiting = this.overview.queue.filter((name) => !this.shown.has(imageName(name)));
    if (waiting.length > 0) return this.show(waiting[0]);
    if (this.overview.images === 0) return this.notifier.warn('No recording is available: start roadbook label with --drive FOLDER');
    this.wantsImage = true;
    if (!this.overview.running) await this.learn();
  }

  async neighbour(step: number): Promise<void> {
    const other = step < 0 ? this.image?.before : this.image?.after;
    if (other) await this.show(other);
  }

  async camera(camera: number): Promise<void> {
    if (this.image) await this.show({ ...this.image, camera });
  }

  // Selects the least certain open hypothesis in this image.
  private ask(): void {
    const next = this.asked.open().find((h) => !this.asked.isSkipped(h));
    this.choose(next && !this.isDone() ? { type: 'hypothesis', index: next.index } : { type: 'none' });
  }

  // -- answers

  private async send(drafts: WindowDraft[]): Promise<boolean> {
    const { image } = this;
    const labels = await this.work.createAll(drafts);
    if (labels.length === 0 && image) void this.showAgain(image);
    return labels.length > 0;
  }

  answer(right: boolean): void {
    this.flush();
    const kind = right ? kPerson : rejectedKind(kPerson);
    const label = this.window();
    if (label && isRejected(label) === right) {
      void this.work.change(label, { kind });
      return;
    }
    const h = this.hypothesis();
    if (!h || !this.image) return;
    this.image = { ...this.image, hypotheses: this.image.hypotheses.filter((other) => other.index !== h.index) };
    const draft = answerDraft(this.image, h, right);
    this.ask();
    void this.send([draft]).then((stored) => {
      if (stored) this.notifier.status(right ? 'Person saved' : 'No person: saved');
    });
  }

  skip(): void {
    const h = this.hypothesis();
    if (!h) return;
    this.asked.skip(h);
    this.ask();
  }

  /** Completes this image: accepts the likely hypotheses as people and rejects the others. */
  async done(): Promise<void> {
    this.flush();
    if (!this.image) return;
    if (!this.isDone()) {
      const drafts = doneDrafts(this.image, this.asked.open().filter((h) => !this.asked.isSkipped(h)));
      const name = imageName(this.image);
      this.beingSaved.add(name);
      const stored = this.send(drafts).finally(() => this.beingSaved.delete(name));
      this.image = { ...this.image, done: true, hypotheses: [] };
      void stored.then((good) => (good ? this.rounds.imageDone() : undefined));
    }
    await this.next();
  }

  async remove(): Promise<void> {
    this.flush();
    const { image } = this;
    const label = this.window();
    if (!label || !image) return;
    this.choose({ type: 'none' });
    if (await this.work.remove(label)) await this.showAgain(image);
  }

  // -- drawing and shaping

  point(p: Point): void {
    if (this.image) this.drawing.add(p);
  }

  // Selects the new window when it is stored, unless the user has selected something else in the
  // meantime.
  private async drawn(foot: Point, head: Point): Promise<void> {
    const { selectionCount: choices } = this;
    const [label] = await this.work.createAll([drawnDraft(this.image!, { foot, head, outline: [] })]);
    if (!label) return;
    if (this.selectionCount === choices) this.select({ type: 'window', id: label.id });
    this.notifier.status(`Person ${label.id} saved`);
    await this.refresh();
  }

  /**
   * Moves feet and head of the selected window by the given number of pixels. Returns false if no
   * window is selected.
   */
  reshape(foot: Point, head: Point): boolean {
    const h = this.hypothesis();
    const label = this.window();
    const old = h ?? (label as Upright | null);
    if (!old) return false;
    const shape = reshaped(old, foot, head);
    if (!shape) return true;
    if (h) this.asked.reshape(h, shape);
    else this.shaping.begin(this.store.labels.get(label!.id)!, shape);
    return true;
  }

  // -- learning

  learn(): Promise<void> {
    return this.rounds.learn();
  }

  /** A round has begun or ended. */
  async learned(state: string, error: string): Promise<void> {
    if (state === 'failed') this.notifier.warn(`Training failed: ${error}`);
    await this.refresh();
    if (state !== 'done') return;
    const last = this.overview.rounds.at(-1);
    if (last && this.active) this.notifier.status(`Round ${last.round}: ${last.found} likely in ${last.images} images`);
    if (this.wantsImage && this.overview.queue.length === 0) this.notifier.warn('All images have been shown');
    else if (this.wantsImage) await this.next();
  }
}
