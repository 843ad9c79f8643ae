import { rejectedKind, type Box, type Draft, type Hypothesis, type Point, type Shape } from '../types';

/** Returns the corners counter-clockwise, starting at the front right corner. */
export function cornersOf(box: Box): Point[] {
  const c = Math.cos(box.heading);
  const s = Math.sin(box.heading);
  const l = box.length / 2;
  const w = box.width / 2;
  return (
    [
      [l, -w],
      [l, w],
      [-l, w],
      [-l, -w],
    ] as Point[]
  ).map(([x, y]) => [box.x + c * x - s * y, box.y + s * x + c * y]);
}

/** Makes a box from three clicks: two ends of a long side, and a point on the opposite side. */
export function boxOfClicks(begin: Point, end: Point, opposite: Point): Box {
  const heading = Math.atan2(end[1] - begin[1], end[0] - begin[0]);
  const length = Math.hypot(end[0] - begin[0], end[1] - begin[1]);
  const left: Point = [-Math.sin(heading), Math.cos(heading)];
  const across = (opposite[0] - begin[0]) * left[0] + (opposite[1] - begin[1]) * left[1];
  return {
    x: (begin[0] + end[0]) / 2 + (across / 2) * left[0],
    y: (begin[1] + end[1]) / 2 + (across / 2) * left[1],
    heading,
    length,
    width: Math.abs(across),
  };
}

/**
 * Returns the same box with its heading along its long side. A user who draws the short side first
 * means this heading too.
 */
export function longWays(box: Box): Box {
  if (box.length >= box.width) return box;
  return { ...turned(box, Math.PI / 2), length: box.width, width: box.length };
}

export function boxOf(label: Partial<Box> & { shape?: Shape }): Box | null {
  if (label.shape !== 'box' || label.x === undefined) return null;
  return {
    x: label.x,
    y: label.y!,
    heading: label.heading!,
    length: label.length!,
    width: label.width!,
  };
}

export function moved(box: Box, dx: number, dy: number): Box {
  return { ...box, x: box.x + dx, y: box.y + dy };
}

export function movedCorners(corners: Point[], dx: number, dy: number): Point[] {
  return corners.map(([x, y]) => [x + dx, y + dy]);
}

export function turned(box: Box, angle: number): Box {
  const heading = box.heading + angle;
  return { ...box, heading: Math.atan2(Math.sin(heading), Math.cos(heading)) };
}

export function turnedCorners(corners: Point[], angle: number): Point[] {
  const [mx, my] = middleOf(corners);
  const c = Math.cos(angle);
  const s = Math.sin(angle);
  return corners.map(([x, y]) => [
    mx + c * (x - mx) - s * (y - my),
    my + s * (x - mx) + c * (y - my),
  ]);
}

export function middleOf(corners: Point[]): Point {
  const sum = corners.reduce<Point>((a, p) => [a[0] + p[0], a[1] + p[1]], [0, 0]);
  return [sum[0] / corners.length, sum[1] / corners.length];
}

/**
 * Returns the next box of a row. Its distance from `last` equals the distance between `before` and
 * `last`. Without `before`, the next box touches the long side of `last`.
 */
export function nextInRow(last: Box, before: Box | null): Box {
  if (before) return moved(last, last.x - before.x, last.y - before.y);
  return moved(
    last,
    -Math.sin(last.heading) * last.width,
    Math.cos(last.heading) * last.width,
  );
}

/**
 * Returns the boxes that fill the row between two boxes, side by side. Empty if there is no room.
 */
export function rowBetween(first: Box, last: Box): Box[] {
  const [dx, dy] = [last.x - first.x, last.y - first.y];
  const apart = Math.hypot(dx, dy);
  const angle = Math.atan2(dy, dx) - first.heading;
  const mean = (a: number, b: number): number => (a + b) / 2;
  const pitch = Math.min(
    mean(first.length, last.length) / Math.max(1e-6, Math.abs(Math.cos(angle))),
    mean(first.width, last.width) / Math.max(1e-6, Math.abs(Math.sin(angle))),
  );
  const count = Math.round(apart / pitch) - 1;
  // Boxes with opposite headings are the same box, so the turn between two boxes is at most a right
  // angle.
  const turn = Math.atan(Math.tan(last.heading - first.heading));
  const at = (a: number, b: number, part: number): number => a + part * (b - a);
  return Array.from({ length: Math.max(0, count) }, (_, i) => {
    const part = (i + 1) / (count + 1);
    return {
      x: at(first.x, last.x, part),
      y: at(first.y, last.y, part),
      heading: first.heading + part * turn,
      length: at(first.length, last.length, part),
      width: at(first.width, last.width, part),
    };
  });
}

/** Returns whether two sides of a polygon meet at a point other than their common corner. */
export function crossesItself(p: Point[]): boolean {
  const side = (o: Point, a: Point, b: Point): number =>
    (a[0] - o[0]) * (b[1] - o[1]) - (a[1] - o[1]) * (b[0] - o[0]);
  const along = (o: Point, a: Point, b: Point): number =>
    (a[0] - o[0]) * (b[0] - o[0]) + (a[1] - o[1]) * (b[1] - o[1]);
  const on = (q: Point, a: Point, b: Point): boolean => side(a, b, q) === 0 && along(q, a, b) <= 0;
  const n = p.length;
  for (let i = 0; i < n; ++i) {
    const [a, b, after] = [p[i], p[(i + 1) % n], p[(i + 2) % n]];
    if (side(a, b, after) === 0 && along(b, a, after) > 0) return true; // back along the same side
    for (let j = i + 2; j < n; ++j) {
      if (i === 0 && j + 1 === n) continue;
      const [c, d] = [p[j], p[(j + 1) % n]];
      if (side(a, b, c) * side(a, b, d) < 0 && side(c, d, a) * side(c, d, b) < 0) return true;
      if (on(c, a, b) || on(d, a, b) || on(a, c, d) || on(b, c, d)) return true;
    }
  }
  return false;
}

/** Returns only the box fields of an object. */
export function boxFields(h: Box): Box {
  return { x: h.x, y: h.y, heading: h.heading, length: h.length, width: h.width };
}

/** Returns the user's answer about a hypothesis: correct or not. */
export function answerOf(h: Hypothesis, right: boolean): Draft {
  const { found } = h;
  return {
    ...boxFields(h),
    shape: 'box',
    kind: right ? h.kind : rejectedKind(h.kind),
    source: right ? 'accepted' : 'detected',
    score: h.probability,
    note: '',
    shaped: JSON.stringify(boxFields(h)) !== JSON.stringify(boxFields(found)),
  };
}
