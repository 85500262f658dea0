// Where an obstacle that moves is at which time.
import type { ObstaclePath } from "../host/protocol";
import { endOf, poseAt, trackOf, type Track } from "./time";

export interface Motion {
  /** x and y of its points, alternating. */
  line: Float64Array;
  /** How far each point is from the first one. */
  offsets: [number, number][];
  /** When it has been at all its points, seconds. */
  end: number;
  /** How far it is from its first point at each time. */
  track: Track;
  repeat: boolean;
}

export function motionOf({ points, repeat }: ObstaclePath): Motion {
  const [, x0, y0] = points[0] ?? [0, 0, 0];
  const track = trackOf(points.map(([t, x, y]) => ({ t, x: x - x0, y: y - y0, theta: 0 })));
  return {
    line: new Float64Array(points.flatMap(([, x, y]) => [x, y])),
    offsets: points.map(([, x, y]) => [x - x0, y - y0]),
    end: endOf(track),
    track,
    repeat,
  };
}

/** How far an obstacle is from where it starts. */
export function offsetAt({ track, repeat, end }: Motion, time: number): { x: number; y: number } {
  const start = track.times[0] ?? 0;
  const there = end - start;
  let moment = time;
  if (repeat && there > 0 && time > start) {
    const since = (time - start) % (2 * there);
    moment = start + Math.min(since, 2 * there - since);
  }
  return poseAt(track, moment) ?? { x: 0, y: 0 };
}
