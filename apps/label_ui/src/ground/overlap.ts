// Computes the overlap of two outlines.
import { cornersOf } from './geometry';
import type { Box, Point } from '../types';

const areaOf = (p: Point[]): number =>
  p.reduce((sum, [x, y], i) => sum + (x * p[(i + 1) % p.length][1] - p[(i + 1) % p.length][0] * y) / 2, 0);

// Returns the part of `p` on the left of the line from `a` to `b` (Sutherland and Hodgman 1974).
function leftOf(p: Point[], a: Point, b: Point): Point[] {
  const side = ([x, y]: Point): number => (b[0] - a[0]) * (y - a[1]) - (b[1] - a[1]) * (x - a[0]);
  return p.flatMap((to, i) => {
    const from = p[(i + p.length - 1) % p.length];
    const [s, t] = [side(from), side(to)];
    const kept: Point[] = [];
    if (s < 0 !== t < 0) kept.push([from[0] + ((to[0] - from[0]) * s) / (s - t), from[1] + ((to[1] - from[1]) * s) / (s - t)]);
    if (t >= 0) kept.push(to);
    return kept;
  });
}

/** Returns the common area of two convex outlines as a share of the smaller one. */
export function overlapShare(a: Point[], b: Point[]): number {
  const [p, q] = [a, b].map((ring) => (areaOf(ring) < 0 ? [...ring].reverse() : ring));
  const both = q.reduce<Point[]>((rest, corner, i) => leftOf(rest, corner, q[(i + 1) % q.length]), p);
  return areaOf(both) / Math.max(1e-9, Math.min(areaOf(p), areaOf(q)));
}

/** Returns whether a box overlaps one of the others by more than `most`. */
export function liesOnAny(box: Box, others: Point[][], most: number): boolean {
  return others.some((other) => overlapShare(cornersOf(box), other) >= most);
}
