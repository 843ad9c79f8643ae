// Builds the answers about an image in the form in which the page sends them.
import { rejectedKind, type PeopleImage, type PersonHypothesis, type Upright, type WindowDraft } from '../types';

export const kPerson = 'person';
const kNobody = rejectedKind(kPerson);
const kLikely = 0.5;

export const isLikely = (h: PersonHypothesis): boolean => h.probability >= kLikely;

/** Without a shape, the answer applies to the rest of the image. */
function draftFor(image: PeopleImage, kind: string, source: WindowDraft['source'], score: number, shape?: Upright): WindowDraft {
  const { session, t_ns, camera } = image;
  const place = shape ? { foot: shape.foot, head: shape.head } : {};
  return { session, t_ns, camera, kind, source, score, note: '', shape: shape ? 'upright' : 'image', ...place };
}

export const drawnDraft = (image: PeopleImage, shape: Upright): WindowDraft => draftFor(image, kPerson, 'drawn', 1, shape);

export const answerDraft = (image: PeopleImage, h: PersonHypothesis, right: boolean): WindowDraft =>
  draftFor(image, right ? kPerson : kNobody, right ? 'accepted' : 'detected', h.probability, h);

/**
 * Accepts the likely hypotheses as people and rejects the other hypotheses. Declares that the image
 * shows no other person.
 */
export const doneDrafts = (image: PeopleImage, open: PersonHypothesis[]): WindowDraft[] => [
  ...open.map((h) => answerDraft(image, h, isLikely(h))),
  draftFor(image, kNobody, 'drawn', 1),
];
