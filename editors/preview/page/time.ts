// Looks up a robot's pose at a time, logarithmic in the number of poses.

/** A pose: metres, and radians counter-clockwise. */
export interface Pose {
  x: number;
  y: number;
  theta: number;
}

/** Poses in order of time. */
export interface Track {
  times: Float64Array;
  xs: Float64Array;
  ys: Float64Array;
  thetas: Float64Array;
}

export interface TimedPose extends Pose {
  t: number;
}

export function trackOf(poses: readonly TimedPose[]): Track {
  const track = {
    times: new Float64Array(poses.length),
    xs: new Float64Array(poses.length),
    ys: new Float64Array(poses.length),
    thetas: new Float64Array(poses.length),
  };
  poses.forEach((pose, index) => {
    track.times[index] = pose.t;
    track.xs[index] = pose.x;
    track.ys[index] = pose.y;
    track.thetas[index] = pose.theta;
  });
  return track;
}

/** How many of the sorted times are not later than `t`. */
export function countUpTo(times: Float64Array, t: number): number {
  let low = 0;
  let high = times.length;
  while (low < high) {
    const middle = (low + high) >>> 1;
    if (at(times, middle) <= t) low = middle + 1;
    else high = middle;
  }
  return low;
}

/** The pose at a time, interpolated; the first pose holds before it, the last after it. Undefined if there is none. */
export function poseAt(track: Track, t: number): Pose | undefined {
  const { times, xs, ys, thetas } = track;
  if (times.length === 0) return undefined;
  const next = countUpTo(times, t);
  const before = Math.max(next - 1, 0);
  const after = Math.min(next, times.length - 1);
  const span = at(times, after) - at(times, before);
  const share = span > 0 ? Math.min(Math.max((t - at(times, before)) / span, 0), 1) : 0;
  const turn = turnBetween(at(thetas, before), at(thetas, after));
  return {
    x: at(xs, before) + share * (at(xs, after) - at(xs, before)),
    y: at(ys, before) + share * (at(ys, after) - at(ys, before)),
    theta: at(thetas, before) + share * turn,
  };
}

/** The time of the last pose; 0 if there is none. */
export function endOf(track: Track): number {
  return track.times.length > 0 ? at(track.times, track.times.length - 1) : 0;
}

/** The shorter turn from one heading to another, radians. */
export function turnBetween(from: number, to: number): number {
  const turn = (to - from) % (2 * Math.PI);
  if (turn > Math.PI) return turn - 2 * Math.PI;
  if (turn < -Math.PI) return turn + 2 * Math.PI;
  return turn;
}

function at(values: Float64Array, index: number): number {
  return values[index] ?? 0;
}
