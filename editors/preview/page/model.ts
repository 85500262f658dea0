// Paths prepared for drawing, once per path: lines, legs for hit tests, and tracks to look up poses by time.
import type { ActionAt, DrivenPath, Obstacle, PlannedAction, PlannedLeg, PlannedPath, PlannedPose, PlannedRobot, SensorCone } from "../host/protocol";
import { motionOf, type Motion } from "./motion";
import { endOf, trackOf, turnBetween, type Pose, type TimedPose, type Track } from "./time";

export interface Leg {
  action: PlannedAction;
  /** Null after an action of unknown duration. */
  start: number | null;
  duration: number;
  /** The line that it is a part of, and the indices of its first and last pose there. */
  line: Float64Array;
  first: number;
  last: number;
  from: Pose;
  to: Pose;
  /** Whether the robot turns on the spot, or waits. */
  isTurn: boolean;
  /** Whether sensors decide if, and how far, it is driven. */
  isPossible: boolean;
}

export interface Robot {
  name: string;
  /** The index of its colour. */
  colour: number;
  body: { length: number; width: number };
  sensors: SensorCone[];
  /** x and y of its poses, alternating. */
  line: Float64Array;
  start: Pose;
  end: Pose;
  legs: Leg[];
  track: Track;
  unknownAfter: PlannedAction | null;
  /** What it may do from there. */
  ways: { line: Float64Array; legs: Leg[] }[];
  /** The known legs, then the possible ones. */
  allLegs: Leg[];
}

/** An obstacle; one that moves, where it is at the start. */
export type ObstacleShape = { name: string; motion: Motion | undefined } & (
  | { x: number; y: number; radius: number }
  | { points: [number, number][] }
);

export interface Collision extends Pose {
  robot: Robot;
  t: number | null;
  /** The robot or obstacle that it hits. */
  other: string;
  action: PlannedAction | null;
}

export interface Model {
  environment: string;
  robots: Robot[];
  obstacles: ObstacleShape[];
  collisions: Collision[];
  /** The last known time, seconds: of robots and, where their path is not known to its end, of obstacles. */
  duration: number;
  /** Whether the duration of the whole path is known. */
  isComplete: boolean;
}

/** A run. */
export interface Driven {
  /** By their names. */
  robots: Map<string, DrivenRobot>;
  duration: number;
}

export interface DrivenRobot {
  line: Float64Array;
  track: Track;
  end: Pose | undefined;
  nodes: [number, number][];
  edges: [[number, number], [number, number]][];
}

export function modelOf(path: PlannedPath): Model {
  const robots = path.robots.map(robotOf);
  const collisions = path.collisions.flatMap((collision): Collision[] => {
    const robot = robots.find(({ name }) => name === collision.robot);
    if (!robot) return [];
    const { x, y, theta, t, action } = collision;
    const other = "robot" in collision.with ? collision.with.robot : collision.with.obstacle;
    return [{ robot, x, y, theta, t, action, other }];
  });
  const obstacles = path.obstacles.map(shapeOf);
  const ends = robots.map(({ track }) => endOf(track));
  if (path.duration === null) ends.push(...obstacles.map(({ motion }) => motion?.end ?? 0));
  return {
    environment: path.environment,
    robots,
    obstacles,
    collisions,
    duration: Math.max(0, ...ends),
    isComplete: path.duration !== null,
  };
}

export function drivenOf(path: DrivenPath): Driven {
  const robots = path.robots.map(({ name, poses, map }): [string, DrivenRobot] => [
    name,
    { line: lineOf(poses), track: trackOf(poses), end: poses.at(-1), nodes: map.nodes, edges: map.edges },
  ]);
  return {
    robots: new Map(robots),
    duration: Math.max(0, ...robots.map(([, { track }]) => endOf(track))),
  };
}

function robotOf(robot: PlannedRobot, colour: number): Robot {
  const { name, body, sensors, poses, unknownAfter, possible = [] } = robot;
  const start: Pose = poses[0] ?? { x: 0, y: 0, theta: 0 };
  const line = lineOf(poses);
  const legs = legsOf(poses, robot.legs, line, false);
  const ways = possible.map((way) => {
    const line = lineOf(way.poses);
    return { line, legs: legsOf(way.poses, way.legs, line, true) };
  });
  return {
    name,
    colour,
    body,
    sensors,
    line,
    start,
    end: poses.at(-1) ?? start,
    legs,
    track: trackOf(timedPoses(poses, legs)),
    unknownAfter,
    ways,
    allLegs: [...legs, ...ways.flatMap((way) => way.legs)],
  };
}

function legsOf(poses: readonly PlannedPose[], legs: readonly PlannedLeg[], line: Float64Array, isPossible: boolean): Leg[] {
  return legs.map((leg, index): Leg => {
    const first = legs[index - 1]?.last ?? 0;
    const from = poses[first] ?? { x: 0, y: 0, theta: 0 };
    const to = poses[leg.last] ?? from;
    // A full circle ends where it began, too.
    const isTurn = poses.slice(first, leg.last + 1).every(({ x, y }) => Math.hypot(x - from.x, y - from.y) < 1e-9);
    return { ...leg, line, first, from, to, isTurn, isPossible };
  });
}

/** The poses whose time is known, and those where the robot waits for its next leg. */
function timedPoses(poses: readonly PlannedPose[], legs: readonly Leg[]): TimedPose[] {
  const timed: TimedPose[] = [];
  const add = (pose: Pose, t: number): void => {
    timed.push({ t, x: pose.x, y: pose.y, theta: pose.theta });
  };
  const start = poses[0];
  if (start) add(start, 0);
  for (const leg of legs) {
    if (leg.start === null) break;
    if (leg.start > (timed.at(-1)?.t ?? 0)) add(leg.from, leg.start);
    for (const pose of poses.slice(leg.first + 1, leg.last + 1)) {
      if (pose.t !== null) add(pose, pose.t);
    }
  }
  return timed;
}

function lineOf(poses: readonly { x: number; y: number }[]): Float64Array {
  const line = new Float64Array(2 * poses.length);
  poses.forEach(({ x, y }, index) => {
    line[2 * index] = x;
    line[2 * index + 1] = y;
  });
  return line;
}

/** Where the possible ways of a robot end, but those that it only turns or waits on. */
export function possibleEnds({ ways }: Robot): Pose[] {
  return ways.flatMap(({ legs }) => (legs.every(({ isTurn }) => isTurn) ? [] : legs.slice(-1).map(({ to }) => to)));
}

function shapeOf(obstacle: Obstacle): ObstacleShape {
  const { name, path } = obstacle;
  const motion = path && motionOf(path);
  return "corners" in obstacle
    ? { name, motion, points: obstacle.corners }
    : { name, motion, x: obstacle.centre[0], y: obstacle.centre[1], radius: obstacle.radius };
}

/** Whether a leg belongs to a statement, to one in its blocks, or to a movement that these do; a statement may run more than once. */
export function isLegOf(leg: Leg, at: ActionAt | null): boolean {
  if (at === null) return false;
  const { movement, index, last = index } = at;
  const statements = [...(leg.action.calls ?? []), statementOf(leg)];
  return statements.some((statement) => statement.movement === movement && statement.index >= index && statement.index <= last);
}

/** Whether a leg is one of this very statement. */
export function isStatementOf(leg: Leg, at: ActionAt | null): boolean {
  const { movement, index } = statementOf(leg);
  return at?.movement === movement && at.index === index;
}

/** The statement of a leg, with the movement that it is written in. */
function statementOf({ action: { movement, index, done = movement } }: Leg): { movement: string; index: number } {
  return { movement: done, index };
}

/** How far the driven end is off the planned one: metres and radians. */
export function deviation(planned: Pose, driven: Pose): { distance: number; angle: number } {
  return {
    distance: Math.hypot(driven.x - planned.x, driven.y - planned.y),
    angle: Math.abs(turnBetween(planned.theta, driven.theta)),
  };
}

/** A rectangle on the floor, metres. */
export interface Bounds {
  left: number;
  bottom: number;
  right: number;
  top: number;
}

/** The bounds of all paths, robots and obstacles. */
export function boundsOf(model: Model, driven: Driven | undefined): Bounds {
  const bounds = { left: Infinity, bottom: Infinity, right: -Infinity, top: -Infinity };
  const include = (x: number, y: number, margin: number): void => {
    if (!Number.isFinite(x) || !Number.isFinite(y)) return;
    bounds.left = Math.min(bounds.left, x - margin);
    bounds.right = Math.max(bounds.right, x + margin);
    bounds.bottom = Math.min(bounds.bottom, y - margin);
    bounds.top = Math.max(bounds.top, y + margin);
  };
  const includeLine = (line: Float64Array, margin: number): void => {
    for (let index = 0; index + 1 < line.length; index += 2) include(line[index] ?? 0, line[index + 1] ?? 0, margin);
  };
  for (const { name, line, body, ways } of model.robots) {
    const margin = Math.hypot(body.length, body.width) / 2;
    for (const part of [line, ...ways.map((way) => way.line)]) includeLine(part, margin);
    const run = driven?.robots.get(name);
    if (run) includeLine(run.line, margin);
  }
  for (const obstacle of model.obstacles) {
    for (const [dx, dy] of obstacle.motion?.offsets ?? [[0, 0]]) {
      if ("points" in obstacle) for (const [x, y] of obstacle.points) include(x + dx, y + dy, 0);
      else include(obstacle.x + dx, obstacle.y + dy, obstacle.radius);
    }
  }
  if (bounds.left > bounds.right) return { left: -1, bottom: -1, right: 1, top: 1 };
  return bounds;
}
