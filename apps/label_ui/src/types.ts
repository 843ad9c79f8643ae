// The data exchanged with the server. Metres and radians, map frame: x east, y north, headings from
// x to y.

export type Point = [number, number];

/** A vehicle pose: x, y, heading, stamp. */
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

/** An image of a session. Stamps are text, because they exceed the precision of numbers. */
export interface ImageName {
  session: number;
  t_ns: string;
  camera: number;
}

/** A window, in pixels of its image. */
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
  /** The images of other sessions in which the label was found too. */
  further?: Further;
  /** Only in messages about a change: the name of the request that made it. */
  request?: string;
}

/**
 * Further anchors of a label. `apart_m` is the root mean square distance from its own anchor.
 * `sigmas` is the median distance in standard deviations.
 */
export interface Further {
  apart_m: number;
  sigmas: number;
  /** The distance is larger than the uncertainty of the poses allows: the map is deformed. */
  contradicts: boolean;
  images: { session: string; camera: string; apart_m: number }[];
}

/** Labels are in the version that the check used. */
export interface PaintReport {
  looked: number;
  gone: { id: number; version: number; session: string }[];
  further: (Further & { id: number; version: number })[];
}

export interface Hypothesis extends Box {
  /** Unique among the hypotheses of all rounds. */
  index: number;
  round: number;
  kind: string;
  /**
   * Probability from the similarity to the training examples; 0.5 if positive and negative examples
   * are equally similar. Labels store this value.
   */
  probability: number;
  /**
   * The calibrated probability that such a hypothesis is correct, estimated from the answers so
   * far.
   */
  calibrated: number;
  sigma: number;
  /** The box that the search found, before keys changed it. */
  found: Box;
}

export interface LabelClass {
  kind: string;
  title: string;
  colour: string;
  shape: 'box' | 'polygon';
}

/**
 * The version on which a change is based. Copies of a map file that were labelled separately may
 * share the version number.
 */
export interface Standing {
  version: number;
  when: string;
}

/** `version` grows with each change. `who` made the last change. */
export interface ClassList extends Standing {
  classes: LabelClass[];
  who: string;
}

/** Identifies a map. `map` is the same for the same drives and poses, whatever the file name. */
export interface MapName {
  name: string;
  map: string;
  /** Version of the overhead image. Empty without an image. */
  picture: string;
}

export interface Start extends Omit<MapName, 'picture'> {
  /**
   * The same for all maps that begin with the same drive. Label numbers stay the same between such
   * maps.
   */
  place: string;
  who: string;
  classes: ClassList;
  images: boolean;
  lanes: Point[][];
  poses: Pose[][];
  /** Null if the map has no overhead image. Then only people can be labelled. */
  picture: {
    version: string;
    tile_px: number;
    resolutions: number[];
    extent: [number, number, number, number];
  } | null;
}

/** The hypotheses of the last round. `index` counts within this round. */
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

/** The fields of a label that a user gives. */
export interface Draft extends Partial<Box> {
  kind: string;
  source: 'drawn' | 'accepted' | 'detected';
  score: number;
  note: string;
  shape: Shape;
  corners?: Point[];
  /** The user has corrected the shape of a hypothesis. */
  shaped?: boolean;
}

/** The fields of a label that a user changes. The other fields stay as they are. */
export type Fields = Partial<Draft> & Partial<Pick<WindowDraft, 'foot' | 'head'>>;

/** The fields of a window that a user gives. */
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
  /** As in Hypothesis. */
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
export const needsCheck = (label: Label): boolean =>
  (label.moved_m !== undefined || label.gone !== undefined) && !isRejected(label);
export const isRejected = (label: Label): boolean => label.kind.startsWith('not_');
export const isOnGround = (label: Label): boolean => label.shape === 'box' || label.shape === 'polygon';
/** The name of an image in its address. */
export const imageName = (image: ImageName): string => `${image.session}/${image.t_ns}/${image.camera}`;
export const sameImage = (a: ImageName, b: ImageName): boolean =>
  a.session === b.session && a.t_ns === b.t_ns && a.camera === b.camera;
