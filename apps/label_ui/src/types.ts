// What goes over the wire. Metres and radians, map frame: x east, y north, headings from x to y.

export type Point = [number, number];

export interface Box {
  x: number;
  y: number;
  heading: number;
  length: number;
  width: number;
}

export interface Label extends Partial<Box> {
  id: number;
  version: number;
  deleted: boolean;
  kind: string;
  source: 'drawn' | 'accepted' | 'detected';
  who: string;
  when: string;
  score: number;
  note: string;
  shape: 'box' | 'polygon';
  corners: Point[];
  sigma_m?: number;
  /** Farther than its covariance told, since a person last saw it. */
  moved_m?: number;
}

export interface Hypothesis extends Box {
  index: number;
  probability: number;
  sigma: number;
}

export interface LabelClass {
  kind: string;
  title: string;
  colour: string;
  shape: 'box' | 'polygon';
}

export interface Start {
  name: string;
  who: string;
  classes: LabelClass[];
  images: boolean;
  lanes: Point[][];
  poses: Point[][];
  picture: {
    version: string;
    tile_px: number;
    resolutions: number[];
    extent: [number, number, number, number];
  };
}

export interface HypothesisList {
  round: number;
  kind: string;
  hypotheses: Hypothesis[];
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
  shape: 'box' | 'polygon';
  corners?: Point[];
}

export const rejectedKind = (kind: string): string => `not_${kind}`;
export const needsLook = (label: Label): boolean => label.moved_m !== undefined && !isRejected(label);
export const isRejected = (label: Label): boolean => label.kind.startsWith('not_');
