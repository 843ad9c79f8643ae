// Adds vehicle poses to the places in a change. If the map is rebuilt, the vehicle pose changes,
// and the drawn shape moves with this pose.
import { boxOf, middleOf } from '../ground/geometry';
import type { Box, Point, Pose, Shape } from '../types';

/** A vehicle pose in the map at the time of the change. */
export interface PoseThen {
  session: number;
  t_ns: string;
  camera: 0;
  x: number;
  y: number;
  heading: number;
}

type Body = Record<string, unknown>;
type Placed = Partial<Box> & { shape?: Shape; corners?: Point[]; pose?: PoseThen };

const kPlaceFields = ['x', 'y', 'heading', 'corners'];

/** Returns whether the body has places on the ground in coordinates of one map. */
export function hasMapCoordinates(body: Body): boolean {
  if (body.pose) return false;
  if (Array.isArray(body.labels)) return body.labels.some((label) => hasMapCoordinates(label as Body));
  return kPlaceFields.some((field) => field in body);
}

/**
 * Returns the fields that replace the body's fields on another state of the map. `shape` is the
 * complete shape, if the body has only a part.
 */
export function anchored(poses: Pose[][], body: Body, shape?: Placed): Body | undefined {
  if (!hasMapCoordinates(body)) return undefined;
  if (Array.isArray(body.labels)) {
    const labels = body.labels.map((label) => ({ ...label, ...anchored(poses, label as Body) }));
    return labels.some(hasMapCoordinates) ? undefined : { labels };
  }
  const whole: Placed = { ...(shape ?? body) };
  const box = boxOf(whole);
  if (!box && !whole.corners) return undefined;
  const pose = nearest(poses, box ? [box.x, box.y] : middleOf(whole.corners!));
  if (!pose) return undefined;
  return { ...(box ? { ...box, shape: 'box' } : { corners: whole.corners, shape: 'polygon' }), pose };
}

function nearest(poses: Pose[][], [x, y]: Point): PoseThen | undefined {
  let best: PoseThen | undefined;
  let least = Infinity;
  poses.forEach((track, session) => {
    for (const [px, py, heading, t_ns] of track) {
      const apart = Math.hypot(px - x, py - y);
      if (apart >= least) continue;
      least = apart;
      best = { session, t_ns, camera: 0, x: px, y: py, heading };
    }
  });
  return best;
}
