// Hypotheses that a list from the server still calls open, though they were answered here meanwhile.
import { liesOnAny } from './ground/overlap';
import { rejectedKind, type HypothesisList, type Point } from './types';

const kSamePlace = 0.5; // overlap as a share of the smaller shape: the label answers the hypothesis

/** What was stored since the list was asked for, or is on its way to be. */
export interface Answer {
  kind: string;
  corners: Point[];
}

/** The list without what these answer. */
export function unanswered(list: HypothesisList, answers: Answer[]): HypothesisList {
  const kinds = [list.kind, rejectedKind(list.kind)];
  const places = answers.filter(({ kind }) => kinds.includes(kind)).map(({ corners }) => corners);
  if (places.length === 0) return list;
  const hypotheses = list.hypotheses.filter((h) => !liesOnAny(h, places, kSamePlace));
  const open = new Set(hypotheses.map(({ index }) => index));
  return { ...list, hypotheses, questions: list.questions.filter((i) => open.has(i)) };
}
