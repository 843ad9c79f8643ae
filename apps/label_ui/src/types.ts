// What goes over the wire. Metres and radians, map frame: x east, y north, headings from x to y.

export type Point = [number, number];

/** Of a vehicle: x, y, heading, stamp. */
export type Pose = [number, number, number, string];

export interface Box {
  x: number;
  y: number;
  heading: number;
  length: number;
  width: number;
}

/**
 * On the ground: box or polygon. In an image: an upright window, or the whole image without any
 * other person.
 */
export type Shape = 'box' | 'polygon' | 'upright' | 'image';

/** An image of a session; stamps are longer than numbers of a browser. */
export interface ImageName {
  session: number;
  t_ns: string;
  camera: number;
}

/** Of a window, in pixels of its image. */
export interface Upright {
  foot: Point;
  head: Point;
  outline: Point[];
}

export interface Label extends Partial<Upright>, Partial<Box> {
  id: number;
  version: number;
  deleted: boolean;
  kind: string;
  source: 'drawn' | 'accepted' | 'detected';
  who: string;
  when: string;
  score: number;
  note: string;
  shape: Shape;
  corners: Point[];
  anchor: ImageName;
  sigma_m?: number;
  /**
   * The distance that the label has moved since a user last saw it, if its covariance does not
   * explain it.
   */
  moved_m?: number;
  /** The session whose images show that the labelled marking is no longer painted there. */
  gone?: string;
  /** Images of other sessions in which it was found too. */
  further?: Further;
  /** Only in messages about a change: the name of the request that made it. */
  request?: string;
}

/** Further anchors of a label: how far they put it from its own (root mean square; in the median in standard deviations). */
export interface Further {
  apart_m: number;
  sigmas: number;
  /** Farther than the map's poses allow: something bends it. */
  contradicts: boolean;
  images: { session: string; camera: string; apart_m: number }[];
}

/** Of labels as they stood when they were looked for. */
export interface PaintReport {
  looked: number;
  gone: { id: number; version: number; session: string }[];
  further: (Further & { id: number; version: number })[];
}

export interface Hypothesis extends Box {
  /** No other of any round has it. */
  index: number;
  round: number;
  kind: string;
  /** As like a thing as those it was taught are, one half where it is as like none: what labels keep. */
  probability: number;
  /**
   * The calibrated probability that such a hypothesis is correct, estimated from the answers so
   * far.
   */
  calibrated: number;
  sigma: number;
  /** As the search found it, before keys shaped it. */
  found: Box;
}

export interface LabelClass {
  kind: string;
  title: string;
  colour: string;
  shape: 'box' | 'polygon';
}

/** What a change was made of: files that were copied and labelled apart may share the version. */
export interface Standing {
  version: number;
  when: string;
}

/** `version` grows with each change; `who` made the last. */
export interface ClassList extends Standing {
  classes: LabelClass[];
  who: string;
}

/** Identifies a map. `map` is the same for the same drives and poses, whatever the file name. */
export interface MapName {
  name: string;
  map: string;
  /** Of the overhead image; empty without one. */
  picture: string;
}

export interface Start extends Omit<MapName, 'picture'> {
  /** The same for all maps that began with the same drive: labels keep their numbers from one to the next. */
  place: string;
  who: string;
  classes: ClassList;
  images: boolean;
  lanes: Point[][];
  poses: Pose[][];
  /** Null where the map has no overhead image: then there are people to label. */
  picture: {
    version: string;
    tile_px: number;
    resolutions: number[];
    extent: [number, number, number, number];
  } | null;
}

/** Of the last round; `index` counts within it. */
export interface HypothesisList {
  round: number;
  kind: string;
  hypotheses: Omit<Hypothesis, 'round' | 'kind' | 'found'>[];
  questions: number[];
}

export interface Round {
  round: number;
  kind: string;
  seconds: number;
  positives: number;
  negatives: number;
  found: number;
  fresh: number;
  gone: number;
  accepted: number;
  rejected: number;
}

export interface ProgressReport {
  running: boolean;
  rounds: Round[];
  accepted?: number;
  rejected?: number;
  left?: number;
  counts: Record<string, number>;
}

export interface View {
  session: string;
  camera: string;
  t_ns: string;
  width: number;
  height: number;
  outline: Point[];
  image: string | null;
}

export interface HistoryEvent {
  event: number;
  action: string;
  undoes: number;
  id: number;
  kind: string;
  version: number;
  who: string;
  when: string;
}

/** Fields of a label that a person gives. */
export interface Draft extends Partial<Box> {
  kind: string;
  source: 'drawn' | 'accepted' | 'detected';
  score: number;
  note: string;
  shape: Shape;
  corners?: Point[];
  /** A hand has shaped what a search had found. */
  shaped?: boolean;
}

/** The fields of a label that a user changes. The other fields stay as they are. */
export type Fields = Partial<Draft> & Partial<Pick<WindowDraft, 'foot' | 'head'>>;

/** Fields of a window that a person gives. */
export interface WindowDraft extends ImageName {
  kind: string;
  source: 'drawn' | 'accepted' | 'detected';
  score: number;
  note: string;
  shape: 'upright' | 'image';
  foot?: Point;
  head?: Point;
}

export interface PersonHypothesis extends Upright {
  index: number;
  /** As of a Hypothesis. */
  probability: number;
  calibrated: number;
}

export interface PeopleImage extends ImageName {
  place: string;
  cameras: string[];
  width: number;
  height: number;
  done: boolean;
  hypotheses: PersonHypothesis[];
  before: ImageName | null;
  after: ImageName | null;
}

export interface PeopleRound {
  round: number;
  seconds: number;
  persons: number;
  nobody: number;
  again: number; // how many of them are false alarms of the detector in images that are done
  images: number;
  found: number;
  accepted: number;
  rejected: number;
  missed: number;
}

export interface PeopleOverview {
  images: number;
  done: number;
  persons: number;
  learnt_before: number;
  running: boolean;
  round: number;
  rounds: PeopleRound[];
  queue: ImageName[];
}

export const rejectedKind = (kind: string): string => `not_${kind}`;
export const needsLook = (label: Label): boolean =>
  (label.moved_m !== undefined || label.gone !== undefined) && !isRejected(label);
export const isRejected = (label: Label): boolean => label.kind.startsWith('not_');
export const isOnGround = (label: Label): boolean => label.shape === 'box' || label.shape === 'polygon';
/** In the address of an image. */
export const imageName = (image: ImageName): string => `${image.session}/${image.t_ns}/${image.camera}`;
export const sameImage = (a: ImageName, b: ImageName): boolean =>
  a.session === b.session && a.t_ns === b.t_ns && a.camera === b.camera;
