// What is drawn, made ready once for every path that arrives: lines to draw, legs to hit, and tracks to look up times in.
import type { DrivenPath, NumberedAction, PlannedAction, PlannedPath, Sensor } from "../../src/preview/protocol";
import { endOf, trackOf, turnBetween, type Pose, type TimedPose, type Track } from "./time";

export interface Leg {
  action: PlannedAction;
  /** Null where an earlier action takes an unknown time. */
  start: number | null;
  duration: number;
  /** Indices of its first and last pose in the robot's line. */
  first: number;
  last: number;
  from: Pose;
  to: Pose;
  /** Whether it stays where it is. */
  isTurn: boolean;
}

export interface Robot {
  name: string;
  /** Which of the robots' colours. */
  colour: number;
  body: { length: number; width: number };
  sensors: Sensor[];
  /** x and y of its poses in turn. */
  line: Float64Array;
  start: Pose;
  end: Pose;
  legs: Leg[];
  track: Track;
  unknownAfter: PlannedAction | null;
}

export type Outline = { name: string; x: number; y: number; radius: number } | { name: string; points: [number, number][] };

export interface Crash extends Pose {
  robot: Robot;
  t: number | null;
  /** What it meets: another robot or an obstacle. */
  other: string;
  action: PlannedAction | null;
}

export interface Model {
  environment: string;
  robots: Robot[];
  outlines: Outline[];
  crashes: Crash[];
  /** Seconds until the last pose whose time is known. */
  duration: number;
  /** Whether that is all. */
  isWhole: boolean;
}

/** What was driven, by the robots' names. */
export interface Driven {
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
  const crashes = path.collisions.flatMap((collision): Crash[] => {
    const robot = robots.find(({ name }) => name === collision.robot);
    if (!robot) return [];
    const { x, y, theta, t, action } = collision;
    const other = "robot" in collision.with ? collision.with.robot : collision.with.obstacle;
    return [{ robot, x, y, theta, t, action, other }];
  });
  return {
    environment: path.environment,
    robots,
    outlines: path.obstacles.map(outlineOf),
    crashes,
    duration: Math.max(0, ...robots.map(({ track }) => endOf(track))),
    isWhole: path.duration !== null,
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

function robotOf(robot: PlannedPath["robots"][number], colour: number): Robot {
  const { name, body, sensors, poses, unknownAfter } = robot;
  const start: Pose = poses[0] ?? { x: 0, y: 0, theta: 0 };
  const legs = robot.legs.map((leg, index): Leg => {
    const first = robot.legs[index - 1]?.last ?? 0;
    const from = poses[first] ?? start;
    const to = poses[leg.last] ?? from;
    return { ...leg, first, from, to, isTurn: Math.hypot(to.x - from.x, to.y - from.y) < 1e-9 };
  });
  return {
    name,
    colour,
    body,
    sensors,
    line: lineOf(poses),
    start,
    end: poses.at(-1) ?? start,
    legs,
    track: trackOf(timed(poses, legs)),
    unknownAfter,
  };
}

/** Poses whose time is known, with those in which the robot waits for a leg to begin. */
function timed(poses: PlannedPath["robots"][number]["poses"], legs: Leg[]): TimedPose[] {
  const found: TimedPose[] = [];
  const add = (pose: Pose, t: number): void => {
    found.push({ t, x: pose.x, y: pose.y, theta: pose.theta });
  };
  const start = poses[0];
  if (start) add(start, 0);
  for (const leg of legs) {
    if (leg.start === null) break;
    if (leg.start > (found.at(-1)?.t ?? 0)) add(leg.from, leg.start);
    for (const pose of poses.slice(leg.first + 1, leg.last + 1)) {
      if (pose.t !== null) add(pose, pose.t);
    }
  }
  return found;
}

function lineOf(poses: readonly { x: number; y: number }[]): Float64Array {
  const line = new Float64Array(2 * poses.length);
  poses.forEach(({ x, y }, index) => {
    line[2 * index] = x;
    line[2 * index + 1] = y;
  });
  return line;
}

function outlineOf(obstacle: PlannedPath["obstacles"][number]): Outline {
  return "corners" in obstacle
    ? { name: obstacle.name, points: obstacle.corners }
    : { name: obstacle.name, x: obstacle.centre[0], y: obstacle.centre[1], radius: obstacle.radius };
}

/** Whether a leg is the drive of an action; one movement may be driven more than once. */
export function isOf(leg: Leg, action: NumberedAction | null): boolean {
  return action !== null && leg.action.index === action.index && leg.action.movement === action.movement;
}

/** How far a driven end is off the planned one: metres and radians. */
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

/** What a picture of a path must show. */
export function boundsOf(model: Model, driven: Driven | undefined): Bounds {
  const bounds = { left: Infinity, bottom: Infinity, right: -Infinity, top: -Infinity };
  const include = (x: number, y: number, reach: number): void => {
    if (!Number.isFinite(x) || !Number.isFinite(y)) return;
    bounds.left = Math.min(bounds.left, x - reach);
    bounds.right = Math.max(bounds.right, x + reach);
    bounds.bottom = Math.min(bounds.bottom, y - reach);
    bounds.top = Math.max(bounds.top, y + reach);
  };
  const includeLine = (line: Float64Array, reach: number): void => {
    for (let index = 0; index + 1 < line.length; index += 2) include(line[index] ?? 0, line[index + 1] ?? 0, reach);
  };
  for (const { name, line, body } of model.robots) {
    const reach = Math.hypot(body.length, body.width) / 2;
    includeLine(line, reach);
    const found = driven?.robots.get(name);
    if (found) includeLine(found.line, reach);
  }
  for (const outline of model.outlines) {
    if ("points" in outline) for (const [x, y] of outline.points) include(x, y, 0);
    else include(outline.x, outline.y, outline.radius);
  }
  if (bounds.left > bounds.right) return { left: -1, bottom: -1, right: 1, top: 1 };
  return bounds;
}
