// Removes hypotheses that the server still lists as open although the user has answered them in the
// meantime.
import { liesOnAny } from './ground/overlap';
import { rejectedKind, type HypothesisList, type Point } from './types';

const kSamePlace = 0.5; // overlap as a share of the smaller shape: the label answers the hypothesis

/** An answer that was stored after the request of the list, or that is not stored yet. */
export interface Answer {
  kind: string;
  corners: Point[];
}

/** Returns the list without the answered hypotheses. */
export function unanswered(list: HypothesisList, answers: Answer[]): HypothesisList {
  const kinds = [list.kind, rejectedKind(list.kind)];
  const places = answers.filter(({ kind }) => kinds.includes(kind)).map(({ corners }) => corners);
  if (places.length === 0) return list;
  const hypotheses = list.hypotheses.filter((h) => !liesOnAny(h, places, kSamePlace));
  const open = new Set(hypotheses.map(({ index }) => index));
  return { ...list, hypotheses, questions: list.questions.filter((i) => open.has(i)) };
}
