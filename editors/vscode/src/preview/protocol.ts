// What the server says about paths: docs/protocol.md in types. Lengths are metres, angles radians counter-clockwise,
// times seconds.

export const PLANNED_PATH = "pydslrep/plannedPath";
export const PLANNED_PATH_CHANGED = "pydslrep/plannedPathChanged";
export const PLANNED_AT = "pydslrep/plannedAt";
export const ACTION_LOCATION = "pydslrep/actionLocation";
export const DRIVEN_PATH = "pydslrep/drivenPath";
export const DRIVEN_PATH_CHANGED = "pydslrep/drivenPathChanged";

/** An environment of a program. */
export interface Which {
  uri: string;
  environment: string;
}

export interface PlannedPath {
  environment: string;
  /** Until the last movement ends; null where that cannot be planned. */
  duration: number | null;
  robots: PlannedRobot[];
  obstacles: Obstacle[];
  collisions: Collision[];
}

export interface PlannedRobot {
  name: string;
  body: { length: number; width: number };
  sensors: Sensor[];
  /** The first is where the robot starts. */
  poses: PlannedPose[];
  legs: PlannedLeg[];
  /** The action behind which its poses cannot be planned. */
  unknownAfter: PlannedAction | null;
}

/** A sensor's place on its robot, and what it sees from there. */
export interface Sensor {
  name: string;
  x: number;
  y: number;
  theta: number;
  range: number;
  cone: number;
}

export interface PlannedPose {
  /** Null where an action before it takes an unknown time. */
  t: number | null;
  x: number;
  y: number;
  theta: number;
}

/** The drive of one action. */
export interface PlannedLeg {
  action: PlannedAction;
  start: number | null;
  duration: number;
  /** The index of its last pose; its first is the last one of the drive before. */
  last: number;
}

/** An action by its number within its movement. */
export interface NumberedAction {
  movement: string;
  index: number;
}

export interface PlannedAction extends NumberedAction {
  text: string;
}

export type Obstacle =
  | { name: string; centre: [number, number]; radius: number }
  | { name: string; corners: [number, number][] };

export interface Collision {
  robot: string;
  action: PlannedAction | null;
  t: number | null;
  x: number;
  y: number;
  theta: number;
  with: { obstacle: string } | { robot: string };
}

/** What of planned paths stands at a position. */
export interface PlannedAt {
  environments: string[];
  /** Those that use what stands there. */
  using: string[];
  action: NumberedAction | null;
}

/** The latest run. */
export interface DrivenPath {
  environment: string;
  robots: DrivenRobot[];
}

export interface DrivenRobot {
  name: string;
  poses: { t: number; x: number; y: number; theta: number }[];
  /** What it found on exploring. */
  map: { nodes: [number, number][]; edges: [[number, number], [number, number]][] };
}
