// The state of the page: the labels and hypotheses last received from the server, the selection,
// and the listeners for changes.
import { boxFields } from './ground/geometry';
import { liesOnAny } from './ground/overlap';
import { Trail } from './trail';
import {
  isOnGround, rejectedKind, sameImage,
  type ClassList, type Hypothesis, type HypothesisList, type ImageName, type Label, type LabelClass, type PaintReport, type ProgressReport, type Standing, type Start,
} from './types';

const kOfARound = 1e6; // index = round * kOfARound + number
const kSamePlace = 0.5; // overlap as a share of the smaller shape: the label answers the hypothesis

export type Selection =
  | { type: 'none' }
  | { type: 'label'; id: number }
  | { type: 'hypothesis'; index: number };

type Topic = 'labels' | 'hypotheses' | 'selection' | 'progress' | 'class' | 'classes';

export class Store {
  readonly labels = new Map<number, Label>();
  hypotheses = new Map<number, Hypothesis>();
  questions: number[] = [];
  skipped = new Set<number>();
  round = 0;
  hypothesisKind = '';
  selection: Selection = { type: 'none' };
  /**
   * Counts the user's selections. An action that ends later does not change a newer selection of
   * the user.
   */
  selectionCount = 0;
  readonly trail = new Trail();
  progress: ProgressReport = { running: false, rounds: [], counts: {} };
  /** The classes of the map, and the version on which a change of them is based. */
  classes: LabelClass[];
  classesFrom: Standing;
  kind: string;
  who: string;
  paint: PaintReport = { looked: 0, gone: [], further: [] };

  /**
   * Returns a label as displayed. Keys may have changed its shape, and the change may not be stored
   * yet.
   */
  withUnsavedShape = (label: Label): Label => label;
  /** The same for a hypothesis. The page stores the displayed shape when the user accepts it. */
  withMovedShape = (h: Hypothesis): Hypothesis => h;

  /**
   * Whether the user is working on the selected object. If so, a new round does not deselect it.
   */
  isUserEditing = (): boolean => true;
  /** Called if the selected hypothesis is no longer open because another user has answered it. */
  onQuestionClosed = (_selection: Selection): void => {};

  private readonly listeners = new Map<Topic, (() => void)[]>();
  private readonly changedTopics = new Set<Topic>();

  constructor(readonly start: Start) {
    this.classes = start.classes.classes;
    this.classesFrom = start.classes;
    this.kind = this.classes[0].kind;
    // Another user may have changed the name in another page of this browser. The browser's name
    // applies only to pages opened later.
    this.who = sessionStorage.getItem('roadbook_who') ?? localStorage.getItem('roadbook_who') ?? start.who;
    sessionStorage.setItem('roadbook_who', this.who);
  }

  /**
   * Takes the classes of the map, unless newer ones are known. Notifies everything that uses their
   * colours.
   */
  receiveClasses(list: ClassList): void {
    if (list.version < this.classesFrom.version) return;
    this.classes = list.classes;
    this.classesFrom = list;
    if (!this.classes.some((c) => c.kind === this.kind)) this.kind = this.classes[0].kind;
    this.notify('classes');
    this.notify('class');
  }

  on(topic: Topic, listener: () => void): void {
    this.listeners.set(topic, [...(this.listeners.get(topic) ?? []), listener]);
  }

  /**
   * Notifies the listeners of a topic. Several changes in one turn of the event loop cause one
   * call.
   */
  notify(topic: Topic): void {
    if (this.changedTopics.size === 0) queueMicrotask(() => this.notifyAll());
    this.changedTopics.add(topic);
  }

  private notifyAll(): void {
    const topics = [...this.changedTopics];
    this.changedTopics.clear();
    for (const topic of topics) for (const listener of this.listeners.get(topic) ?? []) listener();
  }

  classOf(kind: string): LabelClass {
    const plain = kind.replace(/^not_/, '');
    return (
      this.classes.find((c) => c.kind === plain) ?? {
        kind: plain,
        title: plain,
        colour: '#D55E00',
        shape: 'box',
      }
    );
  }

  /** Takes a label, unless a newer version is known. Returns whether anything changed. */
  receiveLabel(label: Label): boolean {
    const known = this.labels.get(label.id);
    if (known && known.version >= label.version) return false;
    this.labels.set(label.id, this.withUnsavedShape(label));
    this.notify('labels');
    return true;
  }

  /**
   * Takes all labels. The request for them was sent when the labels `before` were known, so labels
   * received since are newer.
   */
  receiveLabels(labels: Label[], before: Map<number, Label>): void {
    const since = new Map([...this.labels].filter(([id, { version }]) => version !== before.get(id)?.version));
    this.labels.clear();
    for (const label of labels)
      if (label.version >= (since.get(label.id)?.version ?? 0)) this.labels.set(label.id, this.withUnsavedShape(label));
    for (const [id, label] of since) if (!this.labels.has(id)) this.labels.set(id, label);
    this.markPaint();
    this.notify('labels');
  }

  /** Takes the result of the check in the images of other sessions. */
  receivePaint(report: PaintReport): void {
    this.paint = report;
    this.markPaint();
    this.notify('labels');
  }

  // A user who has changed a label since the check has also seen it.
  private markPaint(): void {
    const mark = (id: number, version: number, fields: Pick<Label, 'gone' | 'further'>): void => {
      const label = this.labels.get(id);
      if (label?.version === version) this.labels.set(id, { ...label, ...fields });
    };
    for (const { id, version, session } of this.paint.gone) mark(id, version, { gone: session });
    for (const { id, version, ...further } of this.paint.further) mark(id, version, { further });
  }

  active(): Label[] {
    return [...this.labels.values()].filter((label) => !label.deleted && isOnGround(label));
  }

  /** Labels in an image. */
  inImage(image: ImageName): Label[] {
    return [...this.labels.values()].filter(
      (label) => !label.deleted && !isOnGround(label) && sameImage(label.anchor, image),
    );
  }

  receiveHypotheses(list: HypothesisList): void {
    const { round, kind } = list;
    if (round !== this.round) this.skipped.clear();
    const held = this.isUserEditing() ? this.selectedHypothesis() : null;
    const indexOf = (i: number): number => round * kOfARound + i;
    this.round = round;
    this.hypothesisKind = kind;
    const all = list.hypotheses.map((h): Hypothesis =>
      this.withMovedShape({ ...h, index: indexOf(h.index), round, kind, found: boxFields(h) }),
    );
    this.hypotheses = new Map(all.map((h) => [h.index, h]));
    this.questions = list.questions.map(indexOf);
    if (held && this.isOpen(held)) this.hypotheses.set(held.index, held);
    this.notify('hypotheses');
    const s = this.selection;
    if (s.type !== 'hypothesis' || this.hypotheses.has(s.index)) return;
    this.show({ type: 'none' });
    this.onQuestionClosed(s);
  }

  // For the current round, the server decides which hypotheses are open. A hypothesis of an older
  // round is open if no label overlaps it.
  private isOpen(h: Hypothesis): boolean {
    if (h.round === this.round) return this.hypotheses.has(h.index);
    const known = this.active().filter(({ kind }) => kind === h.kind || kind === rejectedKind(h.kind));
    return !liesOnAny(h, known.map((label) => label.corners), kSamePlace);
  }

  removeHypothesis(index: number): void {
    this.hypotheses.delete(index);
    this.questions = this.questions.filter((i) => i !== index);
    this.notify('hypotheses');
  }

  openQuestions(): number[] {
    return this.questions.filter((i) => !this.skipped.has(i));
  }

  /** Hypotheses that count as found. */
  likely(): Hypothesis[] {
    return [...this.hypotheses.values()].filter((h) => h.probability >= 0.5 && h.round === this.round);
  }

  /** Selects an object on behalf of the user. */
  select(selection: Selection): void {
    ++this.selectionCount;
    if (selection.type === 'label') this.trail.add(selection.id);
    this.show(selection);
  }

  /**
   * Selects the result of an action, unless the user has selected something since `countBefore` was
   * read. Returns whether it selected the result.
   */
  selectUnlessChanged(countBefore: number, selection: Selection): boolean {
    if (countBefore === this.selectionCount) this.show(selection);
    return countBefore === this.selectionCount;
  }

  private show(selection: Selection): void {
    const left = this.selectedHypothesis();
    this.selection = selection;
    this.notify('selection');
    // A hypothesis of an older round stays only while the user is working on it.
    if (left && left.round !== this.round && this.selectedHypothesis() !== left) this.removeHypothesis(left.index);
  }

  selectedLabel(): Label | null {
    if (this.selection.type !== 'label') return null;
    const label = this.labels.get(this.selection.id);
    return label && !label.deleted && isOnGround(label) ? label : null;
  }

  selectedHypothesis(): Hypothesis | null {
    if (this.selection.type !== 'hypothesis') return null;
    return this.hypotheses.get(this.selection.index) ?? null;
  }
}
